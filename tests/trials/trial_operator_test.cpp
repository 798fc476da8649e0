// SPDX-License-Identifier: GPL-3.0-or-later
// What the human of a trial does while the servo does not what he expects, as on a busy computer.
#include "eyeslam/trials/trial_operator.h"

#include <gtest/gtest.h>

#include <memory>

#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "support/short_trial.h"

namespace {

using namespace eyeslam;
using messaging::FixtureKind;
using messaging::ServoState;
using messaging::WantedMode;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

/// The human at his console, and a servo that says whatever the test wants it to.
class Console : public ::testing::Test {
 protected:
  static const support::ShortTrial& trial()
  {
    static const support::ShortTrial made("task: trace\nfault: {kind: operator_lost, must: hold}");
    return made;
  }

  void run(double seconds)
  {
    for (const double end = t_s_ + seconds; t_s_ < end; t_s_ += 1e-3) {
      const std::int64_t utime = kStart_us + static_cast<std::int64_t>(1e6 * t_s_);
      if (static_cast<int>(1e3 * t_s_) % 20 == 0) statuses_.publish(status_, utime, utime);
      link_.drain({utime, utime});
      human_.step(t_s_, {utime, utime});
    }
  }
  bool calibrates() const
  {
    return wishes_.latest() != nullptr && wishes_.latest()->mode == WantedMode::assist &&
           wishes_.latest()->fixture.kind == FixtureKind::calibration;
  }

  messaging::Link link_{"memq://", 1, {}};
  messaging::Publisher<servo_status_t> statuses_{link_};
  messaging::Subscription<operator_t> wishes_{link_};
  trials::TrialOperator human_{trial().setting, *trial().scene, link_};
  messaging::ServoStatus status_;
  double t_s_ = 0.0;
};

TEST_F(Console, ReArmsWhatHoldsBeforeTheAidHasBegun)
{
  run(2.0);
  ASSERT_TRUE(calibrates());
  EXPECT_EQ(wishes_.latest()->rearmed, 0);
  status_.state = ServoState::hold;
  run(1.5);
  EXPECT_EQ(wishes_.latest()->rearmed, 1);
  status_.state = ServoState::assist;
  run(3.0);
  EXPECT_EQ(wishes_.latest()->rearmed, 1) << "nothing holds any more";
}

TEST_F(Console, CalibratesAgainWhereACalibrationBroughtNothing)
{
  status_.state = ServoState::assist;
  run(2.0);
  ASSERT_TRUE(calibrates());
  int rests = 0, begun = 1;
  for (bool before = true; t_s_ < 30.0; before = calibrates()) {
    run(0.1);
    rests += calibrates() ? 0 : 1;
    begun += calibrates() && !before ? 1 : 0;
  }
  EXPECT_EQ(begun, 3) << "of 8 s and some patience each";
  EXPECT_GT(rests, 4) << "the servo must hear that he wants none, to begin anew";
  EXPECT_FALSE(human_.asked());
}

}  // namespace
