// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {

JsonFields JsonFields::parse(const std::string& text, const std::string& path)
{
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) throw FileError(path + ": is no JSON, or only a part of it");
  if (!json.is_object()) throw FileError(path + ": is no JSON object");
  return JsonFields(json, path, "");
}

void JsonFields::fail(const std::string& name, const std::string& what) const
{
  throw FileError(fmt::format("{}: {}{}: {}", path_, prefix_, name, what));
}

const nlohmann::json& JsonFields::at(const std::string& name) const
{
  const auto field = json_.find(name);
  if (field == json_.end()) fail(name, "is missing");
  return *field;
}

double JsonFields::number(const std::string& name, double lowest, double highest) const
{
  const nlohmann::json& value = at(name);
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= lowest && number <= highest)) {
    fail(name, fmt::format("is not a number in [{}, {}]", lowest, highest));
  }
  return number;
}

int JsonFields::whole(const std::string& name, int lowest, int highest) const
{
  if (!at(name).is_number_integer()) fail(name, "is not a whole number");
  return static_cast<int>(number(name, lowest, highest));
}

bool JsonFields::truth(const std::string& name) const
{
  if (!at(name).is_boolean()) fail(name, "is neither true nor false");
  return at(name).get<bool>();
}

std::string JsonFields::text(const std::string& name) const
{
  if (!at(name).is_string()) fail(name, "is no text");
  return at(name).get<std::string>();
}

JsonFields JsonFields::object(const std::string& name) const
{
  if (!at(name).is_object()) fail(name, "is no object");
  return {at(name), path_, prefix_ + name + "."};
}

std::vector<JsonFields> JsonFields::list(const std::string& name) const
{
  const nlohmann::json& values = at(name);
  if (!values.is_array()) fail(name, "is no list");
  std::vector<JsonFields> fields;
  fields.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string place = fmt::format("{}[{}]", name, i);
    if (!values[i].is_object()) fail(place, "is no object");
    fields.push_back(JsonFields(values[i], path_, prefix_ + place + "."));
  }
  return fields;
}

void JsonFields::allowOnly(const std::vector<std::string>& names) const
{
  for (const auto& field : json_.items()) {
    if (std::find(names.begin(), names.end(), field.key()) == names.end()) fail(field.key(), "is unknown");
  }
}

}  // namespace eyeslam::files
