// SPDX-License-Identifier: GPL-3.0-or-later
#include "guidance/guided_tracing.h"

#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/loop_period.h"

namespace eyeslam::apps {

namespace {

fixtures::CurveFixture curveFixture(const GuidedTracingOptions& options)
{
  fixtures::CurveFixtureOptions curve = options.curve;
  curve.compliance.lambda = options.aid == Aid::soft ? options.lambda : 0.0;
  return fixtures::CurveFixture(curve);
}

}  // namespace

GuidedTracing::GuidedTracing(const GuidedTracingOptions& options,
                             std::shared_ptr<const fixtures::CenterlineIndex> vessels,
                             std::vector<Eigen::Vector3d> path, const Eigen::Vector3d& centre)
    : options_(options),
      path_(std::move(path), options.speed_mm_s * kMilli),
      hand_({}, path_.at(0.0).position, options.seed, simulation::kPeriod_s),
      retina_(simulation::retinaMotionOptions(options.motion), options.seed, centre, simulation::kPeriod_s)
{
  now_.null = now_.tip = path_.at(0.0).position;
  now_.world_T_retina = retina_.step(hand_.state()).world_T_retina;
  fixtures_.adopt(std::move(vessels), map_id_);
  fixtures_.assign({curveFixture(options)});
}

void GuidedTracing::adopt(std::shared_ptr<const fixtures::CenterlineIndex> vessels)
{
  fixtures_.adopt(std::move(vessels), map_id_);
}

const TracingStep& GuidedTracing::step(Retina seen)
{
  now_.t_s = simulation::kPeriod_s * static_cast<double>(steps_++);
  now_.target = path_.at(now_.t_s);
  const simulation::SurgeonView view{now_.world_T_retina.toWorld(now_.target.position),
                                     now_.world_T_retina.rotation() * now_.target.velocity, now_.tip, now_.null};
  const auto support =
      options_.aid == Aid::none ? simulation::HandTremor::Support::none : simulation::HandTremor::Support::fixture;
  now_.null = hand_.step(view, support).null;
  now_.world_T_retina = retina_.step(hand_.state()).world_T_retina;
  now_.tip = now_.null;
  if (options_.aid != Aid::none) {
    fixture_ = fixtures_.evaluate(
        {now_.null, now_.world_T_retina.isometry(), simulation::kPeriod_s, seen == Retina::tracked, map_id_});
    if (fixture_.known) now_.tip = fixture_.goal;
  }
  now_.tip_retina = now_.world_T_retina.toRetina(now_.tip);
  return now_;
}

std::vector<Eigen::Vector3d> ontoRetina(const std::vector<Eigen::Vector2d>& path_px, double um_per_px, double height)
{
  const double px = um_per_px * kMicro;
  std::vector<Eigen::Vector3d> path;
  path.reserve(path_px.size());
  for (const Eigen::Vector2d& point : path_px) path.emplace_back(point.x() * px, point.y() * px, -height);
  return path;
}

}  // namespace eyeslam::apps
