// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/configuration/field.h"

namespace eyeslam::configuration {

enum class YamlComments { written, left_out };

/// All options as YAML that `readYaml` reads back, with meaning, unit and range as comments.
std::string yamlOf(const std::vector<Field>& fields, YamlComments comments = YamlComments::written);

/// All options as Markdown tables, one a group, for docs/configuration.md.
std::string markdownOf(const std::vector<Field>& fields);

/// A line "key=value" for each option, in the order of the keys: equal exactly when all values are equal.
std::string canonicalOf(const std::vector<Field>& fields);

/// SHA-256 of the canonical form, 64 hexadecimal digits.
std::string hashOf(const std::vector<Field>& fields);

/// The same four for an options struct.
template <class Options>
std::string yamlOf(Options options, YamlComments comments = YamlComments::written)
{
  return yamlOf(fieldsOf(options), comments);
}
template <class Options>
std::string markdownOf(Options options)
{
  return markdownOf(fieldsOf(options));
}
template <class Options>
std::string canonicalOf(Options options)
{
  return canonicalOf(fieldsOf(options));
}
template <class Options>
std::string hashOf(Options options)
{
  return hashOf(fieldsOf(options));
}

}  // namespace eyeslam::configuration
