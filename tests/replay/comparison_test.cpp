// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/micron_command_t.hpp"
#include "support/encoded_message.h"
#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::Bytes;
using support::headed;
using support::kLogStart;

files::LogEvent eventOf(const char* channel, const Bytes& bytes, std::int64_t utime = kLogStart,
                        std::int64_t number = 0)
{
  return {number, utime, channel, bytes.data(), bytes.size()};
}

micron_command_t command(double x)
{
  auto message = headed<micron_command_t>(kLogStart, 0);
  message.goal[0] = x;
  return message;
}

TEST(Comparison, CountsWhatIsTheSameToTheByteAndWalksOverNothingElse)
{
  Comparison comparison;
  const Bytes same = support::encodedMessage(command(1.0)), foreign{1, 2, 3};
  for (int i = 0; i < 3; ++i) comparison.compare(eventOf("MICRON_COMMAND", same), eventOf("MICRON_COMMAND", same));
  comparison.compare(eventOf("ANY", foreign), eventOf("ANY", foreign));
  ASSERT_EQ(comparison.channels().size(), 2U);
  EXPECT_EQ(comparison.channels()[0].channel, "ANY");
  EXPECT_EQ(comparison.channels()[1].compared, 3);
  EXPECT_EQ(comparison.channels()[1].identical, 3);
  EXPECT_TRUE(comparison.isIdentical());
}

TEST(Comparison, NamesTheFirstFieldThatDiffersAndHowFarEachDoes)
{
  Comparison comparison;
  const Bytes was = support::encodedMessage(command(1.0));
  comparison.compare(eventOf("MICRON_COMMAND", was), eventOf("MICRON_COMMAND", was));
  for (const double x : {1.5, 0.0}) {
    auto message = command(x);
    message.pivot[2] = 7.0;
    const Bytes is = support::encodedMessage(message);
    comparison.compare(eventOf("MICRON_COMMAND", was, kLogStart + 1000, 17), eventOf("MICRON_COMMAND", is));
  }
  const ChannelComparison& channel = comparison.channels().front();
  EXPECT_EQ(channel.compared, 3);
  EXPECT_EQ(channel.identical, 1);
  ASSERT_TRUE(channel.first);
  EXPECT_EQ(channel.first->utime, kLogStart + 1000);
  EXPECT_EQ(channel.first->event, 17);
  EXPECT_EQ(channel.first->field, "goal_x_m");
  EXPECT_EQ(channel.first->recorded, "1");
  EXPECT_EQ(channel.first->recomputed, "1.5");
  ASSERT_EQ(channel.fields.size(), 2U);
  EXPECT_EQ(channel.fields[0].messages, 2);
  EXPECT_EQ(channel.fields[0].largest, 1.0);
  EXPECT_DOUBLE_EQ(channel.fields[0].rms, std::sqrt((0.25 + 1.0) / 2.0));
  EXPECT_EQ(channel.fields[1].field, "pivot_z_m");
  EXPECT_EQ(channel.largest, 7.0);
}

TEST(Comparison, HoldsWhatIsNoNumberForTheSameAsItselfAndForInfinitelyFarFromAnyOther)
{
  Comparison comparison;
  auto nan = command(std::numeric_limits<double>::quiet_NaN());
  const Bytes was = support::encodedMessage(nan), one = support::encodedMessage(command(1.0));
  nan.pivot[0] = 1.0;
  const Bytes is = support::encodedMessage(nan);
  comparison.compare(eventOf("MICRON_COMMAND", was), eventOf("MICRON_COMMAND", is));
  ASSERT_EQ(comparison.channels().front().fields.size(), 1U);
  EXPECT_EQ(comparison.channels().front().fields[0].field, "pivot_x_m");
  comparison.compare(eventOf("MICRON_COMMAND", was), eventOf("MICRON_COMMAND", one));
  EXPECT_TRUE(std::isinf(comparison.channels().front().largest));
}

TEST(Comparison, TellsOfMessagesThatOnlyOneSideHas)
{
  Comparison comparison;
  const Bytes bytes = support::encodedMessage(command(1.0));
  comparison.extra(eventOf("MICRON_COMMAND", bytes, kLogStart + 5));
  comparison.missing(eventOf("MICRON_COMMAND", bytes));
  const ChannelComparison& channel = comparison.channels().front();
  EXPECT_EQ(channel.extra, 1);
  EXPECT_EQ(channel.missing, 1);
  EXPECT_EQ(channel.compared, 0);
  EXPECT_EQ(channel.first->utime, kLogStart + 5);
  EXPECT_EQ(channel.first->field, "message");
  EXPECT_FALSE(comparison.isIdentical());
}

TEST(Comparison, LooksIntoTheTargetsOfAPlan)
{
  Comparison comparison;
  auto plan = headed<burn_plan_t>(kLogStart, 0);
  plan.target.resize(3);
  plan.targets = 3;
  const Bytes was = support::encodedMessage(plan);
  plan.target[1].x_px = 2.5;
  const Bytes is = support::encodedMessage(plan);
  comparison.compare(eventOf("BURN_PLAN", was), eventOf("BURN_PLAN", is));
  const ChannelComparison& channel = comparison.channels().front();
  EXPECT_EQ(channel.first->field, "target_x_px");
  EXPECT_EQ(channel.largest, 2.5);
}

TEST(Comparison, SaysOfBytesThatAreNoMessageThatTheyDiffer)
{
  Comparison comparison;
  Bytes was = support::encodedMessage(command(1.0));
  const Bytes is = was;
  was.pop_back();
  comparison.compare(eventOf("MICRON_COMMAND", was), eventOf("MICRON_COMMAND", is));
  EXPECT_EQ(comparison.channels().front().first->field, "bytes");
  EXPECT_FALSE(comparison.isIdentical());
}

TEST(Comparison, CountsNothingOutsideOfItsPart)
{
  Comparison comparison;
  comparison.restrictTo(kLogStart, kLogStart + 1000);
  const Bytes bytes = support::encodedMessage(command(1.0));
  for (const std::int64_t utime : {kLogStart - 1, kLogStart, kLogStart + 999, kLogStart + 1000}) {
    comparison.compare(eventOf("MICRON_COMMAND", bytes, utime), eventOf("MICRON_COMMAND", bytes, utime));
    comparison.missing(eventOf("LASER_COMMAND", bytes, utime));
  }
  EXPECT_EQ(comparison.channels()[0].missing, 2);
  EXPECT_EQ(comparison.channels()[1].compared, 2);
}

}  // namespace
}  // namespace eyeslam::replay
