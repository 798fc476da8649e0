// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/command_words.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace eyeslam::apps {
namespace {

constexpr const char* kBlanks = " \t\r";

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace

CommandWords::CommandWords(const std::string& line)
{
  const std::string command = trimmed(line.substr(0, line.find('#')));
  std::istringstream stream(command);
  for (std::string word; stream >> word;) words_.push_back(word);
  if (!words_.empty()) rest_ = trimmed(command.substr(words_[0].size()));
}

const std::string& CommandWords::text(std::size_t argument, const std::string& what) const
{
  if (argument >= arguments()) throw CommandError(fmt::format("{}: {} is missing", name(), what));
  return words_[argument + 1];
}

double CommandWords::number(std::size_t argument, const std::string& what, double lowest, double highest) const
{
  const std::string& word = text(argument, what);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (*end != 0 || !(value >= lowest && value <= highest)) {
    throw CommandError(fmt::format("{}: {} '{}' is no number in [{}, {}]", name(), what, word, lowest, highest));
  }
  return value;
}

double CommandWords::numberOr(std::size_t argument, const std::string& what, double lowest, double highest,
                              double preset) const
{
  return argument < arguments() ? number(argument, what, lowest, highest) : preset;
}

long long CommandWords::wholeNumber(std::size_t argument, const std::string& what, long long lowest,
                                    long long highest) const
{
  const double value = number(argument, what, static_cast<double>(lowest), static_cast<double>(highest));
  if (value != std::floor(value)) {
    throw CommandError(fmt::format("{}: {} '{}' is no whole number", name(), what, text(argument, what)));
  }
  return static_cast<long long>(value);
}

void CommandWords::expectAtMost(std::size_t count) const
{
  if (arguments() > count) throw CommandError(fmt::format("{}: '{}' is too much", name(), words_[count + 1]));
}

}  // namespace eyeslam::apps
