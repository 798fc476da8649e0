// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/authentication.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

namespace eyeslam::messaging {
namespace {

using ::testing::HasSubstr;

Key keyOf(std::uint8_t first)
{
  Key key;
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(first + i);
  return key;
}

std::vector<std::uint8_t> signedMessage(const Authenticator& authenticator, std::vector<std::uint8_t> body)
{
  const Tag tag = authenticator.tag("CHANNEL", body.data(), body.size());
  body.insert(body.end(), tag.begin(), tag.end());
  return body;
}

class KeyFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text, mode_t mode = 0600)
  {
    const std::string path = ::testing::TempDir() + "eyeslam_key_" + std::to_string(::getpid());
    std::ofstream(path) << text;
    ::chmod(path.c_str(), mode);
    path_ = path;
    return path;
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string path_;
};

std::string refusalOf(const std::string& path)
{
  try {
    readKey(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

RC_GTEST_PROP(Authenticator, AcceptsWhatItSignedAndNothingWithOneBitFlipped, (std::vector<std::uint8_t> body))
{
  const Authenticator authenticator(keyOf(1));
  std::vector<std::uint8_t> message = signedMessage(authenticator, body);
  RC_ASSERT(authenticator.verifies("CHANNEL", message.data(), message.size()));
  const auto bit = *rc::gen::inRange<std::size_t>(0, message.size() * 8);
  message[bit / 8] = static_cast<std::uint8_t>(message[bit / 8] ^ (1U << (bit % 8)));
  RC_ASSERT(!authenticator.verifies("CHANNEL", message.data(), message.size()));
}

TEST(Authenticator, RefusesAnotherKeyAnotherChannelAndAMessageShorterThanATag)
{
  const Authenticator authenticator(keyOf(1));
  const std::vector<std::uint8_t> message = signedMessage(authenticator, {1, 2, 3});
  EXPECT_FALSE(Authenticator(keyOf(2)).verifies("CHANNEL", message.data(), message.size()));
  EXPECT_FALSE(authenticator.verifies("CHANNEL2", message.data(), message.size()));
  EXPECT_FALSE(authenticator.verifies("CHANNEL", message.data(), kTagBytes - 1));
}

// The NUL between name and body: "AB" + "C" is not "A" + "BC".
TEST(Authenticator, KeepsTheEndOfTheChannelApartFromTheStartOfTheMessage)
{
  const Authenticator authenticator(keyOf(1));
  const std::uint8_t body[] = {'B', 'C'};
  EXPECT_NE(authenticator.tag("AB", body + 1, 1), authenticator.tag("A", body, 2));
}

// Expected: python3 -c "import hashlib; print(hashlib.blake2b(b'A\0BC', key=bytes(range(1, 33)),
// digest_size=16).hexdigest())"
TEST(Authenticator, IsKeyedBlake2bOfChannelNulAndBody)
{
  const Tag expected = {0xdf, 0xc7, 0x59, 0xe2, 0x54, 0x56, 0x3f, 0x14, 0xd6, 0xc3, 0x78, 0x84, 0xb7, 0x8a, 0xf0, 0x4f};
  const std::uint8_t body[] = {'B', 'C'};
  EXPECT_EQ(Authenticator(keyOf(1)).tag("A", body, 2), expected);
}

TEST_F(KeyFile, GivesTheBytesOfItsHexadecimalDigits)
{
  const Key key = readKey(write("0102030405060708090a0b0c0d0e0f101112131415161718191A1B1C1D1E1F20\n"));
  EXPECT_EQ(key, keyOf(1));
}

TEST_F(KeyFile, IsRefusedByNameWhenMissingWrongOrOpenToOthers)
{
  const std::string digits(64, 'a');
  EXPECT_THAT(refusalOf("/nowhere/key"), HasSubstr("'/nowhere/key': No such file"));
  EXPECT_THAT(refusalOf(::testing::TempDir()), HasSubstr("Is a directory"));
  EXPECT_THAT(refusalOf(write("")), HasSubstr("is not 64 hexadecimal digits"));
  EXPECT_THAT(refusalOf(write(digits + "a")), HasSubstr("is not 64 hexadecimal digits"));
  EXPECT_THAT(refusalOf(write(digits + "aa")), HasSubstr("is not 64 hexadecimal digits"));
  EXPECT_THAT(refusalOf(write(digits.substr(2))), HasSubstr("is not 64 hexadecimal digits"));
  EXPECT_THAT(refusalOf(write(digits.substr(1) + "x")), HasSubstr("is not 64 hexadecimal digits"));
  EXPECT_THAT(refusalOf(write(digits, 0644)), HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace eyeslam::messaging
