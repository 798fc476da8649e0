// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "eyeslam/configuration/field.h"

namespace eyeslam::configuration {

/// What is wrong with a configuration: one line that names file or option, key, and what would be right.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A value for one key, not yet checked against any struct.
struct Assignment {
  std::string key;
  std::string text;
  std::string origin;  ///< where it stands, for messages: "my.yaml:3", "--set"
};

/// What becomes of a YAML list: an error, or the text that a list option reads, "1 2 3" of [1, 2, 3] or of
/// [[1, 2], [3]], with a semicolon between the lists of lists of a list.
enum class YamlLists { refused, joined };

/// Reads a YAML file of nested groups.
/// @throws ConfigurationError when it cannot be read, is no YAML, has a key twice, or a list where a value should be
std::vector<Assignment> readYaml(const std::string& path, YamlLists lists = YamlLists::refused);

/// The same of a text that came some other way. @param name  what stands for the file in messages
std::vector<Assignment> parseYaml(const std::string& name, const std::string& text,
                                  YamlLists lists = YamlLists::refused);

/// Reads "group.key=value" as it follows `--set`.
/// @throws ConfigurationError when there is no `=`
Assignment parseSetting(const std::string& setting);

/// @throws ConfigurationError naming the first key that is unknown, or whose value has the wrong type, is not finite
///         or out of range; the fields assigned before it have changed, so assign to a copy
void assign(std::vector<Field>& fields, const std::vector<Assignment>& assignments);

/// The options with the assignments applied, later ones over earlier ones; all or, by exception, none.
template <class Options>
Options applied(Options options, const std::vector<Assignment>& assignments)
{
  std::vector<Field> fields = fieldsOf(options);
  assign(fields, assignments);
  return options;
}

}  // namespace eyeslam::configuration
