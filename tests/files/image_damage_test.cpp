// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/image_damage.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>

namespace eyeslam::files {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const std::string& ending, const std::vector<int>& parameters = {})
{
  cv::Mat image(60, 80, CV_8UC3);
  cv::randu(image, 0, 255);
  Bytes bytes;
  cv::imencode(ending, image, bytes, parameters);
  return bytes;
}

std::vector<Bytes> goodImages()
{
  return {encoded(".png"),
          encoded(".jpg"),
          encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}),
          encoded(".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2}),
          encoded(".bmp"),
          encoded(".tif")};
}

TEST(ImageDamage, FindsNoneInWhatEncodersWrite)
{
  for (const Bytes& bytes : goodImages()) EXPECT_EQ(damageIn(bytes), "");
}

TEST(ImageDamage, FindsNoneInTrailingBytesAfterTheEnd)
{
  for (Bytes bytes : {encoded(".png"), encoded(".jpg")}) {
    bytes.insert(bytes.end(), {1, 2, 3});
    EXPECT_EQ(damageIn(bytes), "");
  }
}

TEST(ImageDamage, FindsEveryCutOfPngAndJpeg)
{
  for (const Bytes& bytes : {encoded(".png"), encoded(".jpg")}) {
    for (std::size_t size = 8; size < bytes.size(); size += 97) {
      EXPECT_NE(damageIn(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))), "") << size;
    }
  }
}

TEST(ImageDamage, FindsEveryFlippedBitOfAPng)
{
  const Bytes good = encoded(".png");
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    Bytes bytes = good;
    bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    EXPECT_NE(damageIn(bytes), "");
  }
}

TEST(ImageDamage, FindsAnEmptyFile) { EXPECT_NE(damageIn({}), ""); }

}  // namespace
}  // namespace eyeslam::files
