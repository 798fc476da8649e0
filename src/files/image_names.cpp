// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/image_names.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// The run of digits from `at` on, without leading zeros, and where it ends.
std::string number(const std::string& text, std::size_t& at)
{
  std::size_t end = at;
  while (end < text.size() && isDigit(text[end])) ++end;
  while (at + 1 < end && text[at] == '0') ++at;
  std::string digits = text.substr(at, end - at);
  at = end;
  return digits;
}

std::vector<std::string> filesIn(const std::string& folder)
{
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path().string());
  }
  return paths;
}

std::vector<std::string> filesLike(const std::string& pattern)
{
  glob_t found{};
  std::vector<std::string> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0) paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return paths;
}

}  // namespace

bool naturalLess(const std::string& a, const std::string& b)
{
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string m = number(a, i);
      const std::string n = number(b, j);
      if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // im1 and im01 differ by a zero only: some fixed order
}

bool isImageName(const std::string& path)
{
  static const std::array<const char*, 12> kEndings = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp",
                                                       ".pgm", ".ppm", ".pnm",  ".jp2", ".webp", ".jpe"};
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

bool isGlob(const std::string& path) { return path.find_first_of("*?[") != std::string::npos && !fs::exists(path); }

std::vector<std::string> imagesOf(const std::string& folder_or_glob)
{
  std::error_code error;
  std::vector<std::string> paths;
  try {
    paths = fs::is_directory(folder_or_glob, error) ? filesIn(folder_or_glob) : filesLike(folder_or_glob);
  } catch (const fs::filesystem_error& failure) {
    throw FileError(folder_or_glob + ": " + failure.code().message());
  }
  paths.erase(std::remove_if(paths.begin(), paths.end(), [](const std::string& p) { return !isImageName(p); }),
              paths.end());
  if (paths.empty()) throw FileError(folder_or_glob + ": holds no image (png, jpg, tif, bmp, pgm, ppm, ...)");
  std::sort(paths.begin(), paths.end(), naturalLess);
  return paths;
}

}  // namespace eyeslam::files
