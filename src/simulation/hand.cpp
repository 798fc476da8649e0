// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hand.h"

namespace eyeslam::simulation {

Hand::Hand(const HandOptions& options, const Eigen::Vector3d& start, std::uint64_t seed, double period_s)
    : start_(start), surgeon_(options.surgeon, start, period_s), tremor_(options.tremor, seed, period_s)
{
  state_.null = start;
}

const HandState& Hand::step(const SurgeonView& view, HandTremor::Support support)
{
  const HandTremor::Displacement& unmeant = tremor_.step(support);
  const Eigen::Vector3d& meant = surgeon_.step(view);
  state_.null = meant + unmeant.sum();
  state_.travel = meant - start_;
  state_.tremor = unmeant.tremor;
  return state_;
}

}  // namespace eyeslam::simulation
