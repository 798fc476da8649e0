// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "eyeslam/tracking/track_result.h"

namespace eyeslam::files {

/// One row of `trajectory.csv` (contracts, section 3).
struct TrajectoryRow {
  std::int64_t frame = 0;  ///< number in the video
  double t = 0.0;          ///< s since frame 0 of the video
  tracking::TrackResult result;
  double cpu_ms = 0.0;      ///< thread CPU time of the tracker
  double map_cpu_ms = 0.0;  ///< that of the published map's slice
};

/// The header line, without its end.
std::string trajectoryHeader();
/// The row as it stands in the file, without its end.
std::string trajectoryLine(const TrajectoryRow& row);

/// Writes `trajectory.csv` row by row; memory does not grow with the video.
class TrajectoryFile {
 public:
  /// @param path  where to write; `shown` names the file in messages
  /// @throws FileError
  TrajectoryFile(const std::string& path, std::string shown);
  void add(const TrajectoryRow& row);
  /// Makes sure that every row has arrived. @throws FileError
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void writeLine(const std::string& line);
  [[noreturn]] void fail() const;

  std::string shown_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace eyeslam::files
