// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/log_reader.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;
constexpr std::int64_t kSearches = 4;            // of the whole file, for events within others
constexpr std::int64_t kOverlap_us = 1'000'000;  // by which two recordings that were joined may overlap

std::uint64_t numberAt(const std::uint8_t* at, int bytes)
{
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8U | at[i];
  return value;
}

bool fits(std::uint64_t value) { return value <= std::uint64_t{std::numeric_limits<std::int64_t>::max()}; }

}  // namespace

LogReader::LogReader(const std::string& path) : stream_(path, std::ios::binary | std::ios::ate), buffer_(kChunk)
{
  std::error_code ignored;  // a folder can be opened, but not read
  if (!stream_ || std::filesystem::is_directory(path, ignored))
    throw FileError(path + ": cannot be opened; an LCM log is wanted, as lcm-logger writes it");
  size_ = std::max<std::int64_t>(0, stream_.tellg());
  stream_.seekg(0);
}

// Makes `wanted` unread bytes available, if the file has them.
bool LogReader::fill(std::size_t wanted)
{
  if (last_ - first_ >= wanted) return true;
  if (first_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + first_, last_ - first_);
    last_ -= first_;
    first_ = 0;
  }
  if (buffer_.size() < wanted) buffer_.resize(2 * wanted);  // twice: what is moved above was paid for by reading on
  // No further than the file was when it was opened: a logger may be writing, and what is not whole is no damage.
  const std::int64_t left = size_ - offset_ - static_cast<std::int64_t>(last_ - first_);
  const auto room = static_cast<std::int64_t>(buffer_.size() - last_);
  stream_.read(reinterpret_cast<char*>(buffer_.data() + last_), std::clamp<std::int64_t>(left, 0, room));
  last_ += static_cast<std::size_t>(stream_.gcount());
  return last_ - first_ >= wanted;
}

// A header that an event can have.
std::optional<LogReader::Header> LogReader::headerOf(const std::uint8_t* bytes)
{
  const std::uint64_t number = numberAt(bytes + 4, 8), utime = numberAt(bytes + 12, 8);
  Header header;
  header.channel_bytes = static_cast<std::size_t>(numberAt(bytes + 20, 4));
  header.data_bytes = static_cast<std::size_t>(numberAt(bytes + 24, 4));
  if (numberAt(bytes, 4) != kLogMagic || !fits(number) || !fits(utime)) return std::nullopt;
  if (header.channel_bytes == 0 || header.channel_bytes > kLongestChannel || header.data_bytes > kLargestData)
    return std::nullopt;
  header.event.number = static_cast<std::int64_t>(number);
  header.event.utime = static_cast<std::int64_t>(utime);
  return header;
}

// The same among the bytes that are there.
std::optional<LogReader::Header> LogReader::headerAt(std::size_t at) const
{
  if (last_ - first_ < at + kLogHeaderBytes) return std::nullopt;
  return headerOf(buffer_.data() + first_ + at);
}

bool LogReader::isCutOff(const Header& header) const
{
  return offset_ + static_cast<std::int64_t>(header.bytes()) > size_;
}

// Whether an event, or the end of the file, or a header that the file's end cuts off, follows at `end`.
bool LogReader::isFollowed(std::size_t end)
{
  if (fill(end + kLogHeaderBytes)) return headerAt(end).has_value();
  const std::size_t left = std::min<std::size_t>(last_ - first_ - end, 4);
  constexpr std::uint8_t kMagic[] = {0xED, 0xA1, 0xDA, 0x01};
  return std::memcmp(buffer_.data() + first_ + end, kMagic, left) == 0;
}

// The event that begins at the first unread byte, if it is to be believed.
std::optional<LogReader::Header> LogReader::whole()
{
  const std::optional<Header> header = headerAt(0);
  if (!header || isCutOff(*header) || !fill(header->bytes())) return std::nullopt;
  const LogEvent& event = header->event;
  const bool earlier = event.utime < *std::min_element(utimes_.begin(), utimes_.end()) - kOverlap_us;
  if (damaged_ && earlier && !isOfAnotherLog(*header)) return std::nullopt;
  if (isFollowed(header->bytes())) return header;
  // The last one before damage, unless its own length is what is damaged: then the next event lies within it.
  if (damaged_ || event.number - 1 != last_number_ || holdsTheNext(*header)) return std::nullopt;
  return header;
}

// Whether events follow each other from here to the end of the file and all are earlier than what was read: a log that
// was joined. One within a payload ends, and the times go on.
bool LogReader::isOfAnotherLog(const Header& first)
{
  if (offset_ < within_until_) return false;
  const std::int64_t newest = *std::min_element(utimes_.begin(), utimes_.end()) - kOverlap_us;
  std::int64_t at = offset_ + static_cast<std::int64_t>(first.bytes());
  bool another = true;
  while (another && at + static_cast<std::int64_t>(kLogHeaderBytes) <= size_) {
    std::array<std::uint8_t, kLogHeaderBytes> bytes{};
    stream_.clear();
    stream_.seekg(at);
    stream_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    const std::optional<Header> header = stream_ ? headerOf(bytes.data()) : std::nullopt;
    another = header && header->event.utime < newest;
    if (another) at += static_cast<std::int64_t>(header->bytes());
  }
  stream_.clear();
  stream_.seekg(offset_ + static_cast<std::int64_t>(last_ - first_));
  if (!another) within_until_ = at;
  return another;
}

bool LogReader::holdsTheNext(const Header& header)
{
  searched_ += static_cast<std::int64_t>(header.bytes());
  if (searched_ > kSearches * size_) return true;  // as no logger writes it: nothing more is believed on this ground
  for (std::size_t at = kLogHeaderBytes; at < header.bytes(); ++at) {
    const std::optional<Header> inner = headerAt(at);
    if (!inner) continue;
    if (inner->event.number - 1 == header.event.number && inner->event.utime >= header.event.utime) return true;
  }
  return false;
}

std::optional<LogEvent> LogReader::next()
{
  while (fill(1)) {
    fill(kLogHeaderBytes);
    if (std::optional<Header> header = whole()) return taken(*header);
    skip();
  }
  return std::nullopt;
}

// To the next place where an event may begin.
void LogReader::skip()
{
  if (!damaged_) {
    const std::optional<Header> header = headerAt(0);
    damage_.cut_off = header ? isCutOff(*header) : last_ - first_ < kLogHeaderBytes;
    damage_.gaps += 1;
    if (damage_.first_offset < 0) damage_.first_offset = offset_;
  }
  damaged_ = true;
  const auto* begin = buffer_.data() + first_;
  const auto* end = buffer_.data() + last_;
  const auto* found = std::find(begin + 1, end, std::uint8_t{kLogMagic >> 24U});
  const auto skipped = found - begin;
  first_ += static_cast<std::size_t>(skipped);
  offset_ += skipped;
  damage_.skipped_bytes += skipped;
}

LogEvent LogReader::taken(Header header)
{
  const std::uint8_t* bytes = buffer_.data() + first_ + kLogHeaderBytes;
  LogEvent event = header.event;
  event.channel = {reinterpret_cast<const char*>(bytes), header.channel_bytes};
  event.data = bytes + header.channel_bytes;
  event.size = header.data_bytes;
  if (events_ == 0) utimes_.fill(event.utime);
  if (event.utime < utimes_[0]) ++damage_.out_of_order;
  first_ += header.bytes();
  offset_ += static_cast<std::int64_t>(header.bytes());
  damaged_ = false;
  damage_.cut_off = false;
  last_number_ = event.number;
  std::rotate(utimes_.begin(), utimes_.end() - 1, utimes_.end());
  utimes_[0] = event.utime;
  ++events_;
  return event;
}

}  // namespace eyeslam::files
