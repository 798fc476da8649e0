// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/eye_camera.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/sequence_renderer.h"
#include "eyeslam/simulation/view_canvas.h"
#include "eyeslam/simulation/view_planner.h"

namespace eyeslam::simulation {

namespace {

constexpr int kRoundPoses = 60;

/// Once round the start, as far out as the retina may go: what the canvas must hold.
class OnceRound : public ViewMotion {
 public:
  explicit OnceRound(double radius_px) : radius_px_(radius_px) {}

  retina::Pose2 at(double turns) const override
  {
    if (turns == 0.0) return {};
    return {radius_px_ * std::cos(kTwoPi * turns), radius_px_ * std::sin(kTwoPi * turns), 0.0, 1.0};
  }
  std::array<double, 6> warpAt(double) const override { return {}; }

 private:
  double radius_px_;
};

Condition withExposure(Condition condition, const EyeCameraOptions& options)
{
  condition.microscope.optics.exposure_ms = 1e3 * exposureTime(options);
  return condition;
}

cv::Mat eightBits(const cv::Mat& canvas)
{
  cv::Mat bgr(canvas.size(), CV_8UC3);
  const int from_to[] = {0, 0, 1, 1, 2, 2};
  cv::Mat white;
  canvas.convertTo(white, CV_8U, 255.0);
  cv::mixChannels(&white, 1, &bgr, 1, from_to, 3);
  return bgr;
}

}  // namespace

struct EyeCamera::Scene {
  double um_per_px;
  cv::Mat_<float> vessels;
  cv::Mat canvas;
  cv::Point2d map_origin;

  static Scene plan(const EyeCameraOptions& options, const Condition& condition, const Fundus& fundus,
                    std::uint64_t seed)
  {
    const double um = simulation::umPerPx(options, seed);
    const cv::Size size(options.width, options.height);
    const Fundus retina = preparedFundus(fundus, condition.tissue, fundus.um_per_px / um);
    const double rim = condition.microscope.illumination.rim_radius_px * options.width / kUsualWidth_px;
    const OnceRound motion(options.reach_mm * 1e3 / um);
    ViewPlanRequest request{size, kRoundPoses, kRoundPoses, rim, seed, {}};
    if (options.view_x_mm >= 0.0 && options.view_y_mm >= 0.0)
      request.start = cv::Point(cvRound(1e3 * options.view_x_mm / um), cvRound(1e3 * options.view_y_mm / um));
    const ViewPlan view = planView(retina, motion, request);
    const cv::Point2d origin = cv::Point2d(view.area.tl()) + imageCentre(options) - cv::Point2d(view.start);
    return {um, retina.calibre_px(view.area).clone(), canvasOf(retina, view.area), origin};
  }
};

double umPerPx(const EyeCameraOptions& options, std::uint64_t seed)
{
  const SequenceOptions sequence{{options.width, options.height}, 1, options.fps, seed};
  return options.widening * umPerPixel(condition(options.condition).tissue, sequence);
}

SpecularBlooms specularBlooms(const EyeCameraOptions& options, std::uint64_t seed)
{
  return {condition(options.condition).microscope.blooms, cv::Size(options.width, options.height),
          options.width / kUsualWidth_px, options.duration_s, seed};
}

EyeCamera::EyeCamera(const EyeCameraOptions& options, const Fundus& fundus, std::uint64_t seed)
    : EyeCamera(options, withExposure(condition(options.condition), options),
                Scene::plan(options, condition(options.condition), fundus, seed), seed)
{}

EyeCamera::EyeCamera(const EyeCameraOptions& options, const Condition& condition, const Scene& scene,
                     std::uint64_t seed)
    : size_(options.width, options.height),
      um_per_px_(scene.um_per_px),
      vessels_(scene.vessels),
      map_origin_(scene.map_origin),
      retina_(eightBits(scene.canvas)),
      microscope_(condition.microscope, {size_, options.width / kUsualWidth_px, options.fps, options.duration_s},
                  scene.canvas, scene.map_origin, seed)
{}

RenderedFrame EyeCamera::render(const FrameDue& due)
{
  if (due.repeats && !last_.image.empty()) {
    RenderedFrame again = last_;
    again.frame = due.frame;
    again.t_s = due.t_s;
    again.image = last_.image.clone();
    return again;
  }
  // Burns that are new since the last frame: the retina whitens while the pulse goes on.
  for (; burnt_ < due.burns_map.size(); ++burnt_) microscope_.burn(due.burns_map[burnt_]);
  RenderedFrame rendered = microscope_.expose(due.frame, due.view, due.tool);
  last_ = rendered;
  last_.image = rendered.image.clone();
  return rendered;
}

}  // namespace eyeslam::simulation
