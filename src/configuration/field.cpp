// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/configuration/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

namespace eyeslam::configuration {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::max();

std::string rangeText(const Field& field)
{
  const auto& [lowest, highest] = field.range;
  if (lowest <= -kUnbounded && highest >= kUnbounded) return "";
  if (highest >= kUnbounded) return fmt::format(" from {} on", lowest);
  if (lowest <= -kUnbounded) return fmt::format(" up to {}", highest);
  return fmt::format(" in [{}, {}]", lowest, highest);
}

std::string badly(const Field& field, const std::string& text)
{
  return fmt::format("'{}' is not {}", text, allowedText(field));
}

template <class Number>
std::string assignNumber(const Field& field, Number& value, const std::string& text)
{
  Number parsed{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, parsed);  // no locale, no octal
  if (error != std::errc() || rest != end) return badly(field, text);
  const auto number = static_cast<double>(parsed);
  if (!std::isfinite(number) || number < field.range.lowest || number > field.range.highest) return badly(field, text);
  value = parsed;
  return "";
}

std::string assignBool(const Field& field, bool& value, const std::string& text)
{
  if (text != "true" && text != "false") return badly(field, text);
  value = text == "true";
  return "";
}

std::string assignString(const Field& field, std::string& value, const std::string& text)
{
  const auto& choices = field.choices;
  if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end()) return badly(field, text);
  value = text;
  return "";
}

}  // namespace

std::string textOf(const Field& field)
{
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

std::string allowedText(const Field& field)
{
  if (!field.choices.empty()) return fmt::format("one of {}", fmt::join(field.choices, ", "));
  return std::visit(
      [&field](const auto* value) -> std::string {
        using T = std::decay_t<decltype(*value)>;
        if constexpr (std::is_same_v<T, bool>) return "true or false";
        if constexpr (std::is_same_v<T, std::string>) return "text";
        return (std::is_integral_v<T> ? "a whole number" : "a number") + rangeText(field);
      },
      field.value);
}

std::string assignText(Field& field, const std::string& text)
{
  return std::visit(
      [&](auto* value) {
        using T = std::decay_t<decltype(*value)>;
        if constexpr (std::is_same_v<T, bool>)
          return assignBool(field, *value, text);
        else if constexpr (std::is_same_v<T, std::string>)
          return assignString(field, *value, text);
        else
          return assignNumber(field, *value, text);
      },
      field.value);
}

}  // namespace eyeslam::configuration
