// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/image_damage.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace eyeslam::files {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
const char* const kCut = "is cut off";

bool startsWith(const Bytes& bytes, const std::uint8_t* head, std::size_t size)
{
  return bytes.size() >= size && std::equal(head, head + size, bytes.begin());
}

std::uint32_t bigEndian(const Bytes& bytes, std::size_t at, int count)
{
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8U | bytes[at + static_cast<std::size_t>(i)];
  return value;
}

// The table of the reflected polynomial 0xEDB88320 (ISO 3309, as PNG uses it).
std::array<std::uint32_t, 256> crcTable()
{
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
    table[n] = c;
  }
  return table;
}

std::uint32_t crc(const Bytes& bytes, std::size_t from, std::size_t to)
{
  static const std::array<std::uint32_t, 256> kTable = crcTable();
  std::uint32_t c = 0xFFFFFFFFU;
  for (std::size_t i = from; i < to; ++i) c = kTable[(c ^ bytes[i]) & 0xFFU] ^ (c >> 8U);
  return ~c;
}

// A chunk: length (4), name (4), content, checksum over name and content (4).
std::string damageInPng(const Bytes& bytes)
{
  std::size_t at = kPngSignature.size();
  while (at + 12 <= bytes.size()) {
    const std::size_t end = at + 8 + bigEndian(bytes, at, 4);
    if (end + 4 > bytes.size()) return kCut;
    if (crc(bytes, at + 4, end) != bigEndian(bytes, end, 4)) return "is damaged (a checksum is wrong)";
    if (bigEndian(bytes, at + 4, 4) == 0x49454E44U) return "";  // IEND
    at = end + 4;
  }
  return kCut;
}

bool standsAlone(std::uint8_t marker) { return marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8); }

// Segments carry their length; the compressed scan between them is searched for the next marker.
std::string damageInJpeg(const Bytes& bytes)
{
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    const std::uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xFF || marker == 0xFF) {
      ++at;
    } else if (marker == 0xD9) {
      return "";  // end of image
    } else if (standsAlone(marker)) {
      at += 2;
    } else if (at + 4 <= bytes.size()) {
      at += 2 + bigEndian(bytes, at + 2, 2);
    } else {
      return kCut;
    }
  }
  return kCut;
}

}  // namespace

std::string damageIn(const Bytes& bytes)
{
  constexpr std::array<std::uint8_t, 3> kJpegStart = {0xFF, 0xD8, 0xFF};
  if (bytes.empty()) return "is empty";
  if (startsWith(bytes, kPngSignature.data(), kPngSignature.size())) return damageInPng(bytes);
  if (startsWith(bytes, kJpegStart.data(), kJpegStart.size())) return damageInJpeg(bytes);
  return "";
}

}  // namespace eyeslam::files
