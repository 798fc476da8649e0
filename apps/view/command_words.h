// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace eyeslam::apps {

/// A line that cannot be obeyed: what is wrong with it and what would be right, in one line.
class CommandError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A line of the console, word by word: "fixture point 400 300".
class CommandWords {
 public:
  /// Words are separated by white space; what follows a # is a remark.
  explicit CommandWords(const std::string& line);

  bool empty() const { return words_.empty(); }
  /// The word that names the command; empty for an empty line.
  std::string name() const { return empty() ? "" : words_[0]; }
  /// Words after the name.
  std::size_t arguments() const { return empty() ? 0 : words_.size() - 1; }

  /// An argument, from 0. @param what  it is, for the error
  /// @throws CommandError when it is missing
  const std::string& text(std::size_t argument, const std::string& what) const;
  /// @throws CommandError when it is missing, no number, or outside [lowest, highest]
  double number(std::size_t argument, const std::string& what, double lowest, double highest) const;
  /// The same; whole, and `preset` where it is missing.
  double numberOr(std::size_t argument, const std::string& what, double lowest, double highest, double preset) const;
  long long wholeNumber(std::size_t argument, const std::string& what, long long lowest, long long highest) const;
  /// All that follows the name as one text, for file names.
  std::string rest() const { return rest_; }
  /// @throws CommandError when there are more arguments
  void expectAtMost(std::size_t arguments) const;

 private:
  std::vector<std::string> words_;
  std::string rest_;
};

}  // namespace eyeslam::apps
