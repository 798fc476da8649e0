// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/sequence_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/view_canvas.h"
#include "eyeslam/simulation/view_planner.h"

namespace eyeslam::simulation {

namespace {

// Nobody sees the eye's largest jumps of a video whose light goes out.
void jumpInTheDark(EyeMotion& motion, const Condition& condition, const SequenceOptions& options)
{
  const double px_scale = options.size.width / kUsualWidth_px;
  const Illumination light(condition.microscope.illumination, options.size, px_scale, options.frames / options.fps,
                           options.seed);
  Random random(options.seed, 19);
  for (const Illumination::Interval& dark : light.darkIntervals()) {
    const double middle = 0.5 * (dark.from_s + dark.to_s);
    const double length = px_scale * random.uniform(condition.jump_shortest_px, condition.jump_longest_px);
    motion.addJump(middle, length, random.uniform(0.0, kTwoPi));
  }
}

}  // namespace

struct SequenceRenderer::Scene {
  double um_per_px, zoom;
  EyeMotion motion;
  cv::Mat_<float> vessels;
  cv::Mat canvas;
  cv::Point2d map_origin;

  static Scene plan(const Fundus& fundus, const Condition& condition, const SequenceOptions& options)
  {
    const double um = umPerPixel(condition.tissue, options);
    const double zoom = fundus.um_per_px / um;
    const double px_scale = options.size.width / kUsualWidth_px;
    EyeMotion motion(condition.motion, px_scale * condition.motion_factor, options.frames / options.fps, options.seed);
    jumpInTheDark(motion, condition, options);
    const Fundus retina = preparedFundus(fundus, condition.tissue, zoom);
    const double rim = condition.microscope.illumination.rim_radius_px * px_scale;
    const ViewPlan view = planView(retina, motion, {options.size, options.fps, options.frames, rim, options.seed, {}});
    const cv::Point2d centre((options.size.width - 1) / 2.0, (options.size.height - 1) / 2.0);
    const cv::Point2d origin = cv::Point2d(view.area.tl()) + centre - cv::Point2d(view.start);
    return {um, zoom, std::move(motion), retina.calibre_px(view.area).clone(), canvasOf(retina, view.area), origin};
  }
};

double umPerPixel(const TissueOptions& tissue, const SequenceOptions& options)
{
  const double spread = Random(options.seed, 18).uniform(-tissue.um_per_px_spread, tissue.um_per_px_spread);
  const double wider = options.size.width / kUsualWidth_px;
  return tissue.um_per_px * (1.0 + spread) / (wider < 1.0 ? wider : std::sqrt(wider));
}

SequenceRenderer::SequenceRenderer(const Fundus& fundus, const Condition& condition, const SequenceOptions& options)
    : SequenceRenderer(Scene::plan(fundus, condition, options), condition, options)
{}

SequenceRenderer::SequenceRenderer(Scene scene, const Condition& condition, const SequenceOptions& options)
    : options_(options),
      um_per_px_(scene.um_per_px),
      zoom_(scene.zoom),
      motion_(std::move(scene.motion)),
      vessels_(scene.vessels),
      map_origin_(scene.map_origin),
      microscope_(condition.microscope,
                  {options.size, options.size.width / kUsualWidth_px, options.fps, options.frames / options.fps},
                  scene.canvas, scene.map_origin, options.seed)
{}

std::optional<RenderedFrame> SequenceRenderer::next()
{
  if (frame_ >= options_.frames) return std::nullopt;
  return microscope_.expose(frame_++, motion_);
}

std::optional<SequenceRenderer::Rim> SequenceRenderer::rim() const
{
  const Illumination& light = microscope_.illumination();
  if (!light.hasRim()) return std::nullopt;
  return Rim{light.rimCentre().x, light.rimCentre().y, light.rimRadius()};
}

}  // namespace eyeslam::simulation
