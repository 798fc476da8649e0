// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/markup.h"

#include <sodium.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace eyeslam::files {

namespace {

constexpr int kPngEffort = 4;  // of 9: that one takes thirty times as long and saves a tenth

/// Bytes of the UTF-8 letter that begins at `at`; 0: none does.
std::size_t lengthOfLetter(const std::string& text, std::size_t at)
{
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(at);
  if (first < 0x80U) return first >= 0x20U || first == '\t' || first == '\n' ? 1 : 0;
  const std::size_t length = first >= 0xf0U ? 4 : first >= 0xe0U ? 3 : 2;
  if (first < 0xc2U || first > 0xf4U) return 0;
  unsigned letter = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0U) != 0x80U) return 0;
    letter = (letter << 6U) | (byte(at + i) & 0x3fU);
  }
  const unsigned shortest = length == 4 ? 0x10000U : length == 3 ? 0x800U : 0x80U;
  const bool surrogate = letter >= 0xd800U && letter < 0xe000U;
  const bool control = letter < 0xa0U || letter == 0xfffeU || letter == 0xffffU;
  return letter < shortest || letter > 0x10ffffU || surrogate || control ? 0 : length;
}

}  // namespace

std::string escaped(const std::string& text)
{
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = lengthOfLetter(text, at);
    const std::string letter = length > 0 ? text.substr(at, length) : "?";
    at += std::max<std::size_t>(length, 1);
    if (letter == "&") {
      result += "&amp;";
    } else if (letter == "<") {
      result += "&lt;";
    } else if (letter == ">") {
      result += "&gt;";
    } else if (letter == "\"") {
      result += "&quot;";
    } else if (letter == "'") {
      result += "&#39;";
    } else {
      result += letter;
    }
  }
  return result;
}

std::string dataAddress(const std::string& type, const std::vector<unsigned char>& bytes)
{
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  text.resize(text.find('\0'));
  return "data:" + type + ";base64," + text;
}

std::string pngAddress(const cv::Mat& bgr)
{
  std::vector<unsigned char> png;
  cv::imencode(".png", bgr, png, {cv::IMWRITE_PNG_COMPRESSION, kPngEffort});
  return dataAddress("image/png", png);
}

}  // namespace eyeslam::files
