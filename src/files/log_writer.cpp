// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/log_writer.h"

#include <stdexcept>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/log_event.h"

namespace eyeslam::files {

namespace {

void put(std::vector<char>& bytes, std::uint64_t value, int count)
{
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xFFU));
}

}  // namespace

LogWriter::LogWriter(const std::string& path) : file_(path), stream_(file_.partialPath(), std::ios::binary)
{
  header_.reserve(kLogHeaderBytes);
  check();
}

void LogWriter::append(std::string_view channel, const std::uint8_t* data, std::size_t size, std::int64_t utime)
{
  if (channel.empty() || channel.size() > kLongestChannel)
    throw std::invalid_argument("a channel of a log has 1 to 63 characters");
  header_.clear();
  put(header_, kLogMagic, 4);
  put(header_, static_cast<std::uint64_t>(events_++), 8);
  put(header_, static_cast<std::uint64_t>(utime), 8);
  put(header_, channel.size(), 4);
  put(header_, size, 4);
  stream_.write(header_.data(), static_cast<std::streamsize>(header_.size()));
  stream_.write(channel.data(), static_cast<std::streamsize>(channel.size()));
  stream_.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  check();
}

void LogWriter::finish()
{
  stream_.flush();
  check();
  stream_.close();
  check();
  file_.publish();
}

void LogWriter::check()
{
  if (!stream_) throw FileError(file_.path() + ": cannot be written; is the disk full?");
}

}  // namespace eyeslam::files
