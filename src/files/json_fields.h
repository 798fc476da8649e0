// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace eyeslam::files {

/// No map reaches so far: a file that names a place farther out is wrong.
inline constexpr double kFarthest_px = 1e6;

/// A JSON object of a file, read field by field: whatever is wrong names the file and the field ("targets[3].x_px").
/// Each function throws FileError.
class JsonFields {
 public:
  /// The whole text as an object. @param path  for messages
  static JsonFields parse(const std::string& text, const std::string& path);

  bool has(const std::string& name) const { return json_.contains(name); }
  bool isNull(const std::string& name) const { return at(name).is_null(); }
  /// A finite number in [lowest, highest].
  double number(const std::string& name, double lowest, double highest) const;
  /// A whole number, not written as a fraction, in [lowest, highest].
  int whole(const std::string& name, int lowest, int highest) const;
  bool truth(const std::string& name) const;
  std::string text(const std::string& name) const;
  JsonFields object(const std::string& name) const;
  std::vector<JsonFields> list(const std::string& name) const;
  const nlohmann::json& at(const std::string& name) const;
  const nlohmann::json& json() const { return json_; }

  /// Refuses every field that is not among these.
  void allowOnly(const std::vector<std::string>& names) const;
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

 private:
  JsonFields(const nlohmann::json& json, std::string path, std::string prefix)
      : json_(json), path_(std::move(path)), prefix_(std::move(prefix))
  {}

  nlohmann::json json_;
  std::string path_;
  std::string prefix_;
};

}  // namespace eyeslam::files
