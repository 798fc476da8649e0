// SPDX-License-Identifier: GPL-3.0-or-later
// What the whole chain does when the camera freezes, and when the disk is full that vision records on: the real
// tracker sees it and says so. EYESLAM_SIM, EYESLAM_TRACK and EYESLAM_SERVO are the programs.
#include "support/live_chain.h"
#include "support/live_fault.h"

namespace eyeslam {
namespace {

using messaging::ServoState;
using messaging::WantedMode;
using retina::Reason;

class VisionChain : public support::LiveFaultOn<support::LiveChain> {
 protected:
  void expectHoldAsVisionSays(Reason reason)
  {
    const auto says = [&] { return bench.record.poses.last().value.motion.reason == reason; };
    ASSERT_TRUE(bench.runUntil(says, 30'000)) << describe(bench.record.statuses.last());
    ASSERT_EQ(bench.state(), wanted) << "until then: " << describe(bench.record.statuses.last());
    fault_utime = bench.record.poses.last().header.utime_sent;
    const auto stop = expectStop(ServoState::hold, reason);
    ASSERT_TRUE(stop);
    expectInTheCycleThatPasses(0.250, stop->value.pose_age, *stop);
  }
};

TEST_F(VisionChain, ACameraThatFreezesIsSeenByTheTrackerAndHold)
{
  ASSERT_NO_FATAL_FAILURE(bench.startSimulator({"--fault", "camera_freezes@9"}));
  ASSERT_NO_FATAL_FAILURE(bench.startTracker({}));
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::assist));
  expectHoldAsVisionSays(Reason::frozen);
}

TEST_F(VisionChain, AFullLogDiskIsToldByTheTrackerAndHold)
{
  constexpr rlim_t kDisk = 40'000'000;  // bytes: some 7 s
  ASSERT_NO_FATAL_FAILURE(bench.startSimulator({}));
  ASSERT_NO_FATAL_FAILURE(bench.startTracker({"--record", bench.path("record.mkv")}, kDisk));
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::assist));
  expectHoldAsVisionSays(Reason::record_failed);
  EXPECT_EQ(bench.tracker().wait(), 1) << bench.tracker().text();
}

}  // namespace
}  // namespace eyeslam
