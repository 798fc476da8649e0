// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace eyeslam::apps {

enum class Verbosity { quiet, normal };

/// How far the work is, on standard error: a bar with rate and remaining time on a terminal, a line every few seconds
/// elsewhere, nothing when quiet.
class Progress {
 public:
  /// @param total  how many steps there will be, where that is known
  Progress(std::string what, std::optional<std::int64_t> total, Verbosity verbosity);
  /// Clears the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::int64_t done);

 private:
  std::string text(std::int64_t done, double elapsed) const;

  std::string what_;
  std::optional<std::int64_t> total_;
  bool quiet_;
  bool terminal_;
  double start_;
  double shown_;
  bool drawn_ = false;
};

/// "1:05", "2:03:10"; s
std::string durationText(double seconds);

}  // namespace eyeslam::apps
