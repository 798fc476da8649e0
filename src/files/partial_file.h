// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eyeslam::files {

/// A file written beside its place and renamed into it, so that nobody ever meets half of it.
class PartialFile {
 public:
  /// @throws FileError when the folder does not exist or cannot be written, or something else than a file is in its
  /// place
  explicit PartialFile(const std::string& path);
  /// Removes what was written unless it was published.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Where to write; has the same ending, which chooses formats.
  const std::string& partialPath() const { return partial_; }
  const std::string& path() const { return path_; }
  /// @throws FileError
  void publish();

 private:
  std::string path_;
  std::string partial_;
};

}  // namespace eyeslam::files
