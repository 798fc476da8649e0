// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace eyeslam::apps {

/// A folder of one's own for files between programs, gone at the end.
class ScratchFolder {
 public:
  /// @param program  begins its name
  /// @throws std::runtime_error  it cannot be made
  explicit ScratchFolder(const std::string& program);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

}  // namespace eyeslam::apps
