// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/partial_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {

namespace fs = std::filesystem;

PartialFile::PartialFile(const std::string& path) : path_(path)
{
  const fs::path place = path;
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(fmt::format("{}: there is no folder {}", path, folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw FileError(fmt::format("{}: the folder {} cannot be written", path, folder.string()));
  }
  if (fs::exists(place, error) && !fs::is_regular_file(place, error))
    throw FileError(fmt::format("{}: is no ordinary file, and would be replaced; name a file", path));
  partial_ =
      (folder / fmt::format(".{}.partial-{}{}", place.stem().string(), getpid(), place.extension().string())).string();
}

PartialFile::~PartialFile()
{
  std::error_code ignored;  // there may be nothing to remove
  fs::remove(partial_, ignored);
}

void PartialFile::publish()
{
  std::error_code error;
  fs::rename(partial_, path_, error);
  if (error) throw FileError(fmt::format("{}: cannot be written: {}", path_, error.message()));
}

}  // namespace eyeslam::files
