// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>
#include <string>

namespace eyeslam::apps {

/// The call was wrong: exit status 2. One line that names the option and says what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Gives a command line `--help` with these examples at its end, and `--version`.
void addStandardOptions(CLI::App& app, const std::string& examples);

/// Adds a program's options to its command line and returns its work, which is called after parsing.
using ProgramSetup = std::function<std::function<void()>(CLI::App& app)>;

/// A program from the first to the last line: silences OpenCV's and FFmpeg's own messages, parses, runs, and turns
/// every exception into one line on standard error.
/// @param name   as it is called, for its messages
/// @param about  the first line of `--help`
/// @return exit status: 0 done, 1 the work failed, 2 the call was wrong (contracts, section 2)
int runProgram(const char* name, const char* about, int argc, char** argv, const ProgramSetup& setUp) noexcept;

}  // namespace eyeslam::apps
