// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "eyeslam/files/partial_file.h"

namespace eyeslam::files {

/// Writes an ordinary LCM log, which lcm-logplayer plays. The file has its name only when it is whole.
///
///   LogWriter log("trial.lcm");
///   log.append("MICRON_STATE", bytes, size, utime);
///   log.finish();
class LogWriter {
 public:
  /// @throws FileError when it cannot be written there
  explicit LogWriter(const std::string& path);

  /// @param utime  us since 1970, of the reception
  /// @throws FileError  no space is left; std::invalid_argument: the channel is empty or longer than kLongestChannel
  void append(std::string_view channel, const std::uint8_t* data, std::size_t size, std::int64_t utime);
  /// Gives the log its name. @throws FileError
  void finish();

  std::int64_t events() const { return events_; }

 private:
  void check();

  PartialFile file_;
  std::ofstream stream_;
  std::vector<char> header_;
  std::int64_t events_ = 0;
};

}  // namespace eyeslam::files
