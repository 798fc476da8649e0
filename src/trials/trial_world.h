// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/simulation/hardware.h"
#include "eyeslam/simulation/truth_publisher.h"
#include "eyeslam/trials/lock_step_vision.h"
#include "eyeslam/trials/manual_laser.h"
#include "eyeslam/trials/trial_operator.h"
#include "eyeslam/trials/trial_scene.h"
#include "eyeslam/trials/trial_surgeon.h"

namespace eyeslam::trials {

/// Which trial it is, as its log says it (the note of MARK START).
struct TrialName {
  std::string scenario, variant;
  std::uint64_t seed = 0;

  std::string json() const;
  /// @return none where the note is no such
  static std::optional<TrialName> parse(const std::string& note);
};

/// All of a trial but vision and servo, behind messages alone: surgeon, eye, Micron, laser, the human at the console,
/// the truth, and the marks of its log. In lock step and in real time alike; a millisecond is
///
///   if (const auto frame = world.advance(now)) ...;  // the camera's, its exposure is over
///   world.tellTruth(now);
///   ...                                              // vision, in lock step
///   world.act(now);
class TrialWorld {
 public:
  /// @param setting, scene, link  must outlive it; whoever owns the link drains it
  TrialWorld(const TrialSetting& setting, const TrialName& name, const std::string& version, const TrialScene& scene,
             messaging::Link& link);

  /// Whether anybody looks at frames and commands the Micron: not over the bare hand.
  bool needsVision() const { return !setting_.scenario.isManual(); }

  std::optional<simulation::FrameDue> advance(const messaging::ReceiveTime& now);
  void tellTruth(const messaging::ReceiveTime& now);
  /// What the humans do; says when what counts begins, and ends.
  void act(const messaging::ReceiveTime& now);

  /// Since the start, s.
  double time() const { return hardware_.truth().t_s; }
  bool isOver() const;
  /// What stands before the camera now.
  Obstruction obstruction() const { return obstruction_; }

 private:
  void aim();
  void decide(const messaging::ReceiveTime& now);
  void breakThings();
  void setFault(bool broken);
  void mark(std::int16_t kind, const std::string& note, std::int64_t utime);

  const TrialSetting& setting_;
  const TrialScene& scene_;
  TrialName name_;
  std::string version_;
  messaging::Publisher<mark_t> marks_;
  TrialSurgeon surgeon_;
  simulation::Hardware hardware_;
  simulation::TruthPublisher truths_;
  std::optional<TrialOperator> operator_;
  std::optional<ManualLaser> manual_;
  bool started_ = false;
  std::optional<double> counts_s_, done_s_;
  bool broken_ = false;
  Obstruction obstruction_ = Obstruction::none;
};

}  // namespace eyeslam::trials
