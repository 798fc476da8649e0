// SPDX-License-Identifier: GPL-3.0-or-later
// Logs as they are found, and as they are broken (stack, 0.5).
#include "eyeslam/files/log_reader.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/log_writer.h"
#include "eyeslam/files/whole_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;
constexpr std::size_t kData = 40;
constexpr std::size_t kEvent = kLogHeaderBytes + 5 + kData;

struct Found {
  std::vector<std::int64_t> numbers;
  LogDamage damage;
};

class LogReading : public ::testing::Test {
 protected:
  std::string good(int events)
  {
    LogWriter log(path_);
    for (int i = 0; i < events; ++i) {
      const std::vector<std::uint8_t> data(kData, static_cast<std::uint8_t>(i));
      log.append("STATE", data.data(), data.size(), kStart + 1000 * i);
    }
    log.finish();
    const std::vector<std::uint8_t> bytes = readWholeFile(path_);
    return {bytes.begin(), bytes.end()};
  }

  Found read(const std::string& bytes)
  {
    writeWholeFile(path_, bytes);
    LogReader log(path_);
    Found found;
    while (const auto event = log.next()) {
      EXPECT_EQ(event->channel, "STATE");
      found.numbers.push_back(event->number);
    }
    found.damage = log.damage();
    return found;
  }

  support::TemporaryFolder folder_;
  std::string path_ = folder_.path("log.lcm");
  const std::vector<std::int64_t> all_ = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
};

std::vector<std::int64_t> without(std::vector<std::int64_t> numbers, std::initializer_list<std::int64_t> lost)
{
  for (const std::int64_t number : lost) numbers.erase(std::find(numbers.begin(), numbers.end(), number));
  return numbers;
}

void put(std::string& bytes, std::size_t at, std::uint32_t value)
{
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 0xFFU);
}

TEST_F(LogReading, GivesBackWhatWasWritten)
{
  const Found found = read(good(10));
  EXPECT_EQ(found.numbers, all_);
  EXPECT_FALSE(found.damage.any());
}

TEST_F(LogReading, OfATruncatedTailLosesTheLastEventAndSaysSo)
{
  for (std::size_t cut = 1; cut < kEvent; ++cut) {
    const std::string bytes = good(10);
    const Found found = read(bytes.substr(0, bytes.size() - cut));
    ASSERT_EQ(found.numbers, without(all_, {9})) << cut;
    ASSERT_TRUE(found.damage.cut_off) << cut;
    ASSERT_EQ(found.damage.gaps, 1) << cut;
  }
}

TEST_F(LogReading, LosesNoGoodEventAroundJunk)
{
  std::string bytes = good(10);
  bytes.insert(5 * kEvent, std::string(333, 'x'));
  const Found found = read(bytes);
  EXPECT_EQ(found.numbers, all_);
  EXPECT_EQ(found.damage.skipped_bytes, 333);
  EXPECT_EQ(found.damage.gaps, 1);
  EXPECT_EQ(found.damage.first_offset, static_cast<std::int64_t>(5 * kEvent));
  EXPECT_FALSE(found.damage.cut_off);
}

TEST_F(LogReading, LosesOnlyTheEventWhoseHeaderIsBad)
{
  const std::size_t header = 4 * kEvent;
  const std::pair<std::size_t, std::uint32_t> damages[] = {
      {0, 0xEDA1DA02}, {24, 0x7fffffff}, {24, 0xffffffff}, {24, 1U << 30U}, {24, kData + 60},
      {20, 0},         {20, 0xfffffff0}, {20, 1000},       {4, 0xffffffff}, {12, 0x80000000},
  };
  for (const auto& [at, value] : damages) {
    std::string bytes = good(10);
    put(bytes, header + at, value);
    EXPECT_EQ(read(bytes).numbers, without(all_, {4})) << at << " " << value;
  }
}

TEST_F(LogReading, DoesNotTakeALogWithinAPayloadForItsOwnEvents)
{
  const std::string inner = good(10);
  LogWriter log(path_);
  for (int i = 0; i < 3; ++i)
    log.append("STATE", reinterpret_cast<const std::uint8_t*>(inner.data()), inner.size(), kStart + 60'000'000 + i);
  log.finish();
  const std::vector<std::uint8_t> written = readWholeFile(path_);
  std::string bytes(written.begin(), written.end());
  put(bytes, bytes.size() / 3, 0);  // the second event's magic
  EXPECT_EQ(read(bytes).numbers, (std::vector<std::int64_t>{0, 2}));
}

TEST_F(LogReading, FindsAnOlderLogBehindOneThatWasCutOff)
{
  const std::string bytes = good(10);
  std::string older = bytes;
  for (std::size_t i = 0; i < 10; ++i) older[i * kEvent + 14] = static_cast<char>(older[i * kEvent + 14] - 1);  // hours
  const Found found = read(bytes.substr(0, bytes.size() - 20) + older);
  EXPECT_EQ(found.numbers.size(), 19U) << "but the event into which the one that was cut off reaches";
}

TEST_F(LogReading, TakesWhatIsWrittenMeanwhileForNoDamage)
{
  const std::string bytes = good(10);
  writeWholeFile(path_, bytes.substr(0, 5 * kEvent));
  LogReader log(path_);
  std::ofstream(path_, std::ios::binary | std::ios::app) << bytes.substr(5 * kEvent);
  int events = 0;
  while (log.next()) ++events;
  EXPECT_EQ(events, 5);
  EXPECT_FALSE(log.damage().any());
}

TEST_F(LogReading, ComesToAnEndWithEventsThatOverlap)
{
  std::string bytes;
  for (int i = 0; i < 20'000; ++i) {  // each says that it holds all that follow
    std::string header(kLogHeaderBytes + 5, 'S');
    for (std::size_t k = 0; k < kLogHeaderBytes; k += 4) put(header, k, 0);
    put(header, 0, kLogMagic);
    put(header, 8, static_cast<std::uint32_t>(i));
    put(header, 16, 1000);
    put(header, 20, 5);
    put(header, 24, static_cast<std::uint32_t>((20'000 - i) * (kLogHeaderBytes + 5) - kLogHeaderBytes - 5 + 64));
    bytes += header;
  }
  writeWholeFile(path_, bytes + std::string(100, 'x'));
  LogReader log(path_);
  const std::clock_t start = std::clock();
  while (log.next()) continue;
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10.0);
}

TEST_F(LogReading, GoesOnAcrossLogsThatWereJoined)
{
  const std::string bytes = good(10);
  const Found found = read(bytes + bytes);
  EXPECT_EQ(found.numbers.size(), 20U);
  EXPECT_EQ(found.damage.out_of_order, 1);
}

TEST_F(LogReading, GoesOnAfterTheLargestNumber)
{
  std::string bytes = good(10);
  put(bytes, 4 * kEvent + 4, 0x7fffffff);
  put(bytes, 4 * kEvent + 8, 0xffffffff);
  bytes.insert(6 * kEvent, "junk");
  std::vector<std::int64_t> left = without(all_, {5});  // before damage, and its number does not follow
  left[4] = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(read(bytes).numbers, left);
}

TEST_F(LogReading, OfNothingAndOfNoLogFindsNothing)
{
  EXPECT_TRUE(read("").numbers.empty());
  EXPECT_FALSE(read("").damage.any());
  const Found found = read(std::string(100'000, '\xED'));
  EXPECT_TRUE(found.numbers.empty());
  EXPECT_EQ(found.damage.skipped_bytes, 100'000);
  EXPECT_THROW(LogReader(folder_.path("absent.lcm")), FileError);
}

// Every candidate claims most of the file: a reader that goes back for each would need hours.
TEST_F(LogReading, IsNotSlowedByAFileFullOfHeaders)
{
  std::string header = good(1).substr(0, kLogHeaderBytes);
  put(header, 8, 5);  // a number that does not go on: none is believed as the last one before damage
  put(header, 24, 20'000'000);
  std::string bytes;
  while (bytes.size() < 30'000'000) bytes += header;
  LogDamage damage = read(bytes).damage;
  EXPECT_EQ(damage.skipped_bytes, static_cast<std::int64_t>(bytes.size()));
}

RC_GTEST_FIXTURE_PROP(LogReading, AccountsForEveryByteOfAMutatedLog, ())
{
  std::string bytes = good(30);
  const int changes = *rc::gen::inRange(1, 20);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[at] = static_cast<char>(*rc::gen::inRange(0, 256));
  }
  writeWholeFile(path_, bytes);
  LogReader log(path_);
  std::size_t taken = 0;
  while (const auto event = log.next()) taken += kLogHeaderBytes + event->channel.size() + event->size;
  RC_ASSERT(taken + static_cast<std::size_t>(log.damage().skipped_bytes) == bytes.size());
}

}  // namespace
}  // namespace eyeslam::files
