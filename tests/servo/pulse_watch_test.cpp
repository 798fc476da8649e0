// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/pulse_watch.h"

#include <gtest/gtest.h>

using namespace eyeslam;
using namespace eyeslam::servo;
using retina::Reason;

namespace {

constexpr std::int64_t kNow = 1'000'000;

messaging::LaserCommand pulseOf20ms()
{
  messaging::LaserCommand pulse;
  pulse.target = 4;
  pulse.duration = 0.02;
  pulse.power = 0.15;
  return pulse;
}

messaging::LaserState told(std::int64_t pulse, bool done, double duration)
{
  messaging::LaserState state;
  state.pulse = pulse;
  state.pulse_done = done;
  state.pulse_duration = duration;
  return state;
}

}  // namespace

TEST(PulseWatch, AWholePulseEndsWithTheLasersWord)
{
  PulseWatch watch;
  messaging::LaserState state = told(0, false, 0.0);
  watch.begin(7, pulseOf20ms(), {&state, 0.0}, kNow);
  EXPECT_EQ(watch.command().action, messaging::LaserAction::fire);
  EXPECT_EQ(watch.command().pulse, 1);
  state = told(1, false, 0.01);
  EXPECT_FALSE(watch.follow({&state, 0.0}, Reason::none, kNow + 10'000));
  EXPECT_TRUE(watch.isFiring());
  state = told(1, true, 0.02);
  const auto fate = watch.follow({&state, 0.0}, Reason::none, kNow + 20'000);
  ASSERT_TRUE(fate);
  EXPECT_TRUE(fate->begun);
  EXPECT_EQ(fate->index, 7U);
  EXPECT_EQ(fate->emitted_s, 0.02);
  EXPECT_TRUE(watch.isIdle());
  EXPECT_FALSE(watch.follow({&state, 0.0}, Reason::none, kNow + 21'000));  // once
}

TEST(PulseWatch, NeverTakesAnOldPulsesWordForItsOwn)
{
  PulseWatch watch;
  messaging::LaserState state = told(41, true, 0.02);  // of a run before
  watch.begin(0, pulseOf20ms(), {&state, 0.0}, kNow);
  EXPECT_EQ(watch.command().pulse, 42);
  EXPECT_FALSE(watch.follow({&state, 0.0}, Reason::none, kNow + 1000));
}

TEST(PulseWatch, APulseThatWasStoppedNeverGoesOn)
{
  PulseWatch watch;
  messaging::LaserState state = told(1, false, 0.005);
  watch.begin(0, pulseOf20ms(), {nullptr, 1e9}, kNow);
  watch.follow({&state, 0.0}, Reason::pose_stale, kNow + 5000);
  EXPECT_FALSE(watch.isFiring());
  watch.follow({&state, 0.0}, Reason::none, kNow + 6000);
  EXPECT_FALSE(watch.isFiring());
  state = told(1, true, 0.006);
  const auto fate = watch.follow({&state, 0.0}, Reason::none, kNow + 7000);
  ASSERT_TRUE(fate);
  EXPECT_EQ(fate->reason, Reason::pose_stale);
  EXPECT_EQ(fate->emitted_s, 0.006);
}

TEST(PulseWatch, AsksNoLongerThanThePulseAndALittle)
{
  PulseWatch watch;
  messaging::LaserState state = told(1, false, 0.001);
  watch.begin(0, pulseOf20ms(), {nullptr, 1e9}, kNow);
  watch.follow({&state, 0.0}, Reason::none, kNow + 30'000);
  EXPECT_TRUE(watch.isFiring());
  watch.follow({&state, 0.0}, Reason::none, kNow + 30'001);
  EXPECT_FALSE(watch.isFiring());
  EXPECT_FALSE(watch.isIdle());
}

TEST(PulseWatch, OnlyAWordThatIsYoungEnoughSaysThatNothingBegan)
{
  PulseWatch watch;
  messaging::LaserState state = told(0, false, 0.0);
  state.reason = Reason::interlock_open;
  watch.begin(0, pulseOf20ms(), {&state, 0.0}, kNow);
  const std::int64_t last = kNow + 1000;
  watch.follow({&state, 0.0}, Reason::none, last);
  watch.follow({&state, 0.0}, Reason::tip_moves, last + 1000);
  EXPECT_FALSE(watch.follow({&state, 1.0}, Reason::none, last + 900'000));  // heard before
  EXPECT_FALSE(watch.follow({&state, 0.0}, Reason::none, last + 100'000));
  const auto fate = watch.follow({&state, 0.0}, Reason::none, last + 101'001);
  ASSERT_TRUE(fate);
  EXPECT_FALSE(fate->begun);
  EXPECT_EQ(fate->reason, Reason::tip_moves);
}
