// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/configuration/assignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace eyeslam::configuration {
namespace {

// Levenshtein's distance, for "did you mean".
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string nearestKey(const std::vector<Field>& fields, const std::string& key)
{
  const auto nearest = std::min_element(fields.begin(), fields.end(), [&key](const Field& a, const Field& b) {
    return editDistance(a.key, key) < editDistance(b.key, key);
  });
  return nearest == fields.end() ? "" : fmt::format("the nearest is '{}', ", nearest->key);
}

}  // namespace

Assignment parseSetting(const std::string& setting)
{
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigurationError(fmt::format("--set {}: group.key=value is wanted", setting));
  }
  return {setting.substr(0, equals), setting.substr(equals + 1), "--set"};
}

void assign(std::vector<Field>& fields, const std::vector<Assignment>& assignments)
{
  for (const Assignment& assignment : assignments) {
    const auto field =
        std::find_if(fields.begin(), fields.end(), [&assignment](const Field& f) { return f.key == assignment.key; });
    if (field == fields.end()) {
      throw ConfigurationError(fmt::format("{}: key '{}' is unknown; {}--dump-config lists all", assignment.origin,
                                           assignment.key, nearestKey(fields, assignment.key)));
    }
    const std::string wrong = assignText(*field, assignment.text);
    if (!wrong.empty()) throw ConfigurationError(fmt::format("{}: {}: {}", assignment.origin, assignment.key, wrong));
  }
}

}  // namespace eyeslam::configuration
