// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace eyeslam::apps {

/// Lines of a descriptor (terminal, pipe, file) without ever waiting for more than was asked.
class LineReader {
 public:
  explicit LineReader(int descriptor) : descriptor_(descriptor) {}

  /// Waits until something can be read or the time is over; only for that time where the input has ended.
  void wait(int timeout_ms);
  /// The next whole line, without its end; at the end of the input also an unfinished one.
  std::optional<std::string> next();
  /// No line will come any more.
  bool ended() const { return ended_ && text_.empty(); }

 private:
  static constexpr std::size_t kLongest = 1 << 16;  // a longer line is cut there

  int descriptor_;
  std::string text_;  // read, not yet given
  bool ended_ = false;
};

}  // namespace eyeslam::apps
