// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/output_folder.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <opencv2/imgcodecs.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

const char* const kRunRecord = "run.json";  // its arrival says that the rest is there

[[noreturn]] void fail(const fs::path& path, const std::string& cause)
{
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), cause));
}

bool isAlive(const std::string& process)
{
  pid_t id = 0;
  const auto [rest, error] = std::from_chars(process.data(), process.data() + process.size(), id);
  return error != std::errc() || id <= 0 || kill(id, 0) == 0 || errno != ESRCH;
}

std::string withoutTrailingSlash(std::string path)
{
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, std::vector<std::string> owned)
    : folder_(fs::absolute(withoutTrailingSlash(path)).lexically_normal()), owned_(std::move(owned))
{
  if (!folder_.has_filename()) folder_ = folder_.parent_path();  // "results/."
  std::error_code error;
  existed_ = fs::exists(folder_, error);
  if (existed_ && !fs::is_directory(folder_)) fail(folder_, "it is a file; a folder is wanted");
  makeParents();
  // Beside or inside: on the folder's own file system either way, or renaming would copy.
  const std::string prefix = existed_ ? std::string(".partial-") : "." + folder_.filename().string() + ".partial-";
  staging_ = (existed_ ? folder_ : folder_.parent_path()) / prefix;
  removeLeftovers();
  staging_ += std::to_string(getpid());
  if (fs::create_directory(staging_, error)) return;
  removeParents();
  fail(folder_, error ? error.message() : "another run writes there");
}

void OutputFolder::makeParents()
{
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path parent = folder_.parent_path(); !fs::exists(parent, error); parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  std::reverse(missing.begin(), missing.end());
  for (const fs::path& parent : missing) {
    if (!fs::create_directory(parent, error)) {
      removeParents();
      fail(folder_, error.message());
    }
    made_parents_.push_back(parent);
  }
}

void OutputFolder::removeParents() const
{
  std::error_code ignored;  // another run may have put something there
  for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) fs::remove(*parent, ignored);
}

// A run that was killed could not clean up after itself.
void OutputFolder::removeLeftovers() const
{
  const std::string prefix = staging_.filename().string();
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, prefix.size(), prefix) == 0 && !isAlive(name.substr(prefix.size()))) {
      fs::remove_all(entry.path(), ignored);
    }
  }
}

OutputFolder::~OutputFolder()
{
  std::error_code ignored;  // nobody is left to be told
  fs::remove_all(staging_, ignored);
  if (!published_) removeParents();
}

void OutputFolder::write(const std::string& name, const std::string& text) const
{
  try {
    std::error_code ignored;  // writing then says what is wrong
    fs::create_directories(fs::path(staged(name)).parent_path(), ignored);
    writeWholeFile(staged(name), text);
  } catch (const FileError&) {
    fail(final(name), std::make_error_code(static_cast<std::errc>(errno)).message());
  }
}

void OutputFolder::writePng(const std::string& name, const cv::Mat& image) const
{
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  write(name, std::string(bytes.begin(), bytes.end()));
}

void OutputFolder::checkSpace() const
{
  constexpr std::uintmax_t kLeast = 65536;
  std::error_code error;
  const fs::space_info space = fs::space(staging_, error);
  if (!error && space.available < kLeast) fail(folder_, "no space left on its disk");
}

void OutputFolder::moveIntoPlace(const std::string& name) const
{
  std::error_code error;
  const fs::path target = folder_ / name;
  if (fs::is_directory(target, error)) fs::rename(target, staging_ / (name + ".replaced"), error);
  fs::rename(staging_ / name, target, error);
  if (error) fail(target, error.message());
}

void OutputFolder::publish()
{
  std::error_code error;
  if (!existed_) {
    fs::rename(staging_, folder_, error);
    if (error) fail(folder_, error.message());
    published_ = true;
    return;
  }
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
    names.push_back(entry.path().filename().string());
  }
  for (const std::string& name : owned_) {
    if (std::find(names.begin(), names.end(), name) == names.end()) fs::remove_all(folder_ / name, error);
  }
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name != kRunRecord; });
  for (const std::string& name : names) moveIntoPlace(name);
  published_ = true;
}

}  // namespace eyeslam::files
