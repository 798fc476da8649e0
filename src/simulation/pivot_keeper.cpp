// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/pivot_keeper.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/shortened.h"

namespace eyeslam::simulation {

namespace {

constexpr double kShortest = 5e-3, kLongest = 0.1;         // m; a pivot elsewhere is none of a needle's
constexpr double kFarReach_mm = 10.0;                      // the tilt bounds it, not the cylinder of the tip
constexpr std::uint64_t kOtherSeed = 0x9e3779b97f4a7c15U;  // its noise and gains are not the tip's

MicronOptions ofTheShaft(MicronOptions plant)
{
  plant.reach_mm = plant.reach_axial_mm = kFarReach_mm;
  return plant;
}

Eigen::Vector3d across(const Eigen::Vector3d& way, const Eigen::Vector3d& shaft)
{
  return way - way.dot(shaft) * shaft;
}

}  // namespace

PivotKeeper::PivotKeeper(const PivotKeeperOptions& options, const MicronOptions& plant, double ramp_s, double speed,
                         std::uint64_t seed, double period_s)
    : tilt_(std::tan(options.tilt_deg * kDegree)),
      ramp_step_(ramp_s > period_s ? period_s / ramp_s : 1.0),
      pivot_step_(speed * period_s),
      plant_(ofTheShaft(plant), seed + kOtherSeed, period_s),
      length_(options.shaft_mm * kMilli)
{}

void PivotKeeper::step(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft, const Eigen::Vector3d& deflection,
                       const std::optional<Eigen::Vector3d>& pivot)
{
  asked_ = pivot.has_value();
  if (pivot) {
    pivot_ = share_ <= 0.0 ? *pivot : Eigen::Vector3d(pivot_ + shortened(*pivot - pivot_, pivot_step_));
    length_ = std::clamp((pivot_ - null).dot(shaft), kShortest, kLongest);
  }
  share_ = std::clamp(share_ + (asked_ ? ramp_step_ : -ramp_step_), 0.0, 1.0);
  command_ = wanted(shaft, deflection);
  move(null, shaft);
}

void PivotKeeper::stepUnpowered(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft)
{
  asked_ = false;
  move(null, shaft);
}

// The tip's deflection carries the shaft along; what the pivot needs besides is a tilt against the handle.
Eigen::Vector3d PivotKeeper::wanted(const Eigen::Vector3d& shaft, const Eigen::Vector3d& deflection)
{
  const Eigen::Vector3d tilt = across(pivot_ - plant_.fresh().null - deflection, shaft);
  const double most = tilt_ * length_;
  limited_ = asked_ && tilt.norm() > most;
  return deflection + retina::smoothstep(share_) * shortened(tilt, most);
}

void PivotKeeper::move(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft)
{
  plant_.commandDeflection(command_);
  plant_.setShaft(shaft);
  plant_.step(null + length_ * shaft, Eigen::Vector2d::Zero());
}

}  // namespace eyeslam::simulation
