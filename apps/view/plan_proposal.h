// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/messaging/operator_messages.h"

namespace eyeslam::apps {

/// The plan that the human proposes, and may approve by the beginning of its hash.
class PlanProposal {
 public:
  /// Fewer digits of a hash approve nothing.
  static constexpr std::size_t kLeastDigits = 8;

  /// Reads a plan.json. @param map_id  of the live map
  /// @return what to tell the human: targets and hash
  /// @throws FileError, CommandError
  std::string read(const std::string& file, std::int64_t map_id);

  /// The hash that a human's digits name. @param digits  at least kLeastDigits of the hash's 64, from its first
  /// @throws CommandError when nothing is proposed, or they are not its beginning
  messaging::Hash named(const std::string& digits) const;

  /// Null before the first.
  burn_plan_t* message() { return message_ ? &*message_ : nullptr; }

 private:
  std::optional<burn_plan_t> message_;
};

/// 64 lower-case digits.
std::string hexOf(const messaging::Hash& hash);

}  // namespace eyeslam::apps
