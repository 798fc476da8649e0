// SPDX-License-Identifier: GPL-3.0-or-later
// What a live servo does when somebody falls silent; EYESLAM_SERVO is its program.
#include "support/live_bench.h"
#include "support/live_fault.h"

namespace eyeslam {
namespace {

using messaging::ServoState;
using messaging::WantedMode;
using retina::Reason;
using simulation::HardwareFault;

class SilenceFaults : public support::LiveFaultOn<support::LiveBench>, public testing::WithParamInterface<WantedMode> {
 protected:
  void SetUp() override { ASSERT_NO_FATAL_FAILURE(begin(GetParam())); }
};

TEST_P(SilenceFaults, VisionThatStopsIsHoldWhenItsLastFrameIs250MillisecondsOld)
{
  mark();
  bench.vision_speaks = false;
  const auto stop = expectStop(ServoState::hold, Reason::pose_stale);
  ASSERT_TRUE(stop);
  expectInTheCycleThatPasses(0.250, stop->value.pose_age, *stop);
  bench.vision_speaks = true;
  expectOnlyRearmingLeads(wanted);
}

TEST_P(SilenceFaults, AManipulatorThatStopsIsHoldAfter50Milliseconds)
{
  mark();
  has_states = false;
  bench.hardware().inject(HardwareFault::states_stop);
  const auto stop = expectStop(ServoState::hold, Reason::state_stale);
  ASSERT_TRUE(stop);
  // The limit counts from the measurement, which was a millisecond old when it was sent; the age from its receipt in
  // the next cycle.
  const double measured_before = 1e-6 * static_cast<double>(bench.hardware().controller().stateAge_us());
  expectInTheCycleThatPasses(0.050, stop->value.state_age, *stop, measured_before + 1.1e-3);
  bench.hardware().mend(HardwareFault::states_stop);
  expectOnlyRearmingLeads(wanted);
}

TEST_P(SilenceFaults, AHumanWhoseLinkIsLostIsHoldAfter200Milliseconds)
{
  mark();
  bench.operator_speaks = false;
  const auto stop = expectStop(ServoState::hold, Reason::operator_stale);
  ASSERT_TRUE(stop);
  expectInTheCycleThatPasses(0.200, stop->value.operator_age, *stop);
  bench.operator_speaks = true;
  expectOnlyRearmingLeads(wanted);
}

INSTANTIATE_TEST_SUITE_P(While, SilenceFaults, testing::Values(WantedMode::assist, WantedMode::laser),
                         [](const auto& mode) { return mode.param == WantedMode::laser ? "burning" : "guiding"; });

}  // namespace
}  // namespace eyeslam
