// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/whole_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sodium.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20U;

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void fail(const std::string& path, const char* verb)
{
  throw FileError(fmt::format("{}: cannot be {}: {}", path, verb, std::strerror(errno)));
}

File openToRead(const std::string& path)
{
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "read");
  return file;
}

// Calls `use` with block after block of the file.
template <class Use>
void forEachBlock(const std::string& path, Use use)
{
  const File file = openToRead(path);
  std::vector<std::uint8_t> block(kBlock);
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), file.get())) > 0;) use(block.data(), n);
  if (std::ferror(file.get()) != 0) fail(path, "read");
}

}  // namespace

std::vector<std::uint8_t> readWholeFile(const std::string& path)
{
  std::vector<std::uint8_t> bytes;
  forEachBlock(path,
               [&bytes](const std::uint8_t* block, std::size_t n) { bytes.insert(bytes.end(), block, block + n); });
  return bytes;
}

std::string readWholeText(const std::string& path)
{
  const auto bytes = readWholeFile(path);
  return {bytes.begin(), bytes.end()};
}

void writeWholeFile(const std::string& path, const void* bytes, std::size_t size)
{
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) fail(path, "written");
  const bool written = std::fwrite(bytes, 1, size, file.get()) == size && std::fflush(file.get()) == 0;
  if (!written) fail(path, "written");
  if (std::fclose(file.release()) != 0) fail(path, "written");
}

void writeWholeFile(const std::string& path, const std::string& text)
{
  writeWholeFile(path, text.data(), text.size());
}

std::string sha256OfFiles(const std::vector<std::string>& paths)
{
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  for (const std::string& path : paths) {
    forEachBlock(path,
                 [&state](const std::uint8_t* block, std::size_t n) { crypto_hash_sha256_update(&state, block, n); });
  }
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256_final(&state, digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace eyeslam::files
