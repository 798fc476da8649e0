// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_score.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace eyeslam::trials {

namespace {

// Six digits are a thousandth of any error bar, and keep a table readable.
std::string textOf(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string(); }
std::string textOf(std::int64_t value) { return std::to_string(value); }
std::string textOf(std::uint64_t value) { return std::to_string(value); }
const std::string& textOf(const std::string& value) { return value; }
template <class Value>
std::string textOf(const std::optional<Value>& value)
{
  return value ? textOf(*value) : std::string();
}

[[noreturn]] void fail(const char* name, const std::string& text, const char* wanted)
{
  throw std::invalid_argument(fmt::format("column {}: \"{}\" is not {}", name, text, wanted));
}

void assign(const char* /*name*/, const std::string& text, std::string& value) { value = text; }

template <class Number>
void assign(const char* name, const std::string& text, Number& value)
{
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end)
    fail(name, text, std::is_floating_point_v<Number> ? "a number" : "a whole number");
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) fail(name, text, "a finite number");
  }
}

template <class Value>
void assign(const char* name, const std::string& text, std::optional<Value>& value)
{
  value.reset();
  if (!text.empty()) assign(name, text, value.emplace());
}

using Json = nlohmann::ordered_json;

Json jsonOfValue(double value) { return std::isfinite(value) ? Json(value) : Json(); }
template <class Value>
Json jsonOfValue(const Value& value)
{
  return value;
}
template <class Value>
Json jsonOfValue(const std::optional<Value>& value)
{
  return value ? jsonOfValue(*value) : Json();
}

std::vector<std::string> namesOfColumns()
{
  std::vector<std::string> names;
  const TrialScore score;
  TrialScore::visit(score, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

}  // namespace

const std::vector<std::string>& columns()
{
  static const std::vector<std::string> kColumns = namesOfColumns();
  return kColumns;
}

std::vector<std::string> rowOf(const TrialScore& score)
{
  std::vector<std::string> row;
  row.reserve(columns().size());
  TrialScore::visit(score, [&](const char*, const auto& value) { row.push_back(textOf(value)); });
  return row;
}

TrialScore scoreOf(const std::vector<std::string>& row)
{
  if (row.size() != columns().size())
    throw std::invalid_argument(fmt::format("{} columns instead of {}", row.size(), columns().size()));
  TrialScore score;
  auto cell = row.begin();
  TrialScore::visit(score, [&](const char* name, auto& value) { assign(name, *cell++, value); });
  return score;
}

std::string jsonOf(const TrialScore& score)
{
  Json json;
  TrialScore::visit(score, [&](const char* name, const auto& value) { json[name] = jsonOfValue(value); });
  Json more = Json::object();
  for (const auto& [name, value] : score.more) more[name] = jsonOfValue(value);
  json["more"] = std::move(more);
  // A file's name need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace eyeslam::trials
