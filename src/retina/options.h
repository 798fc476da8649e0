// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace eyeslam::retina {

/// The closed interval in which an option may lie.
///
/// Every options struct lists its fields once, in a static member
/// `template <class Self, class Visitor> static void visit(Self& self, Visitor& visitor)`, calling
///   visitor.field("name", self.name, Range{lowest, highest}, "unit", "what it does; source")   numbers and bools
///   visitor.choice("name", self.name, {"first", "second"}, "what it does; source")             std::string choices
///   visitor.group("name", self.group)                                                          a nested options struct
/// YAML and `--set` keys, range checks, dump, hash and docs/configuration.md come from that list.
struct Range {
  double lowest = -std::numeric_limits<double>::max();
  double highest = std::numeric_limits<double>::max();
};

}  // namespace eyeslam::retina
