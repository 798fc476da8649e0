// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/microscope.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/retina_sampler.h"

namespace eyeslam::simulation {

namespace {

constexpr int kMostSubExposures = 32;
constexpr double kSubExposure_px = 2.0;  // the retina moves no more between two of them: under the optics' blur
constexpr double kSeen = 0.5;            // of the light: below it the retina counts as hidden

double travel(const retina::Pose2& a, const retina::Pose2& b, const cv::Size& view)
{
  const double corner = 0.5 * std::hypot(view.width, view.height);
  return std::hypot(b.x - a.x, b.y - a.y) + corner * (std::abs(b.theta - a.theta) + std::abs(b.scale - a.scale));
}

}  // namespace

Microscope::Microscope(const MicroscopeOptions& options, const View& view, cv::Mat canvas, cv::Point2d map_origin,
                       std::uint64_t seed)
    : optics_(options.optics),
      view_(view),
      illumination_(options.illumination, view.size, view.px_scale, view.duration_s, seed),
      blooms_(options.blooms, view.size, view.px_scale, view.duration_s, seed),
      instrument_(options.instrument, view.size, view.px_scale, view.duration_s, seed),
      laser_(options.laser, view.px_scale),
      sensor_(options.sensor, seed),
      canvas_(std::move(canvas)),
      map_origin_(map_origin),
      focus_phase_(Random(seed, 16).uniform(0.0, kTwoPi)),
      picture_(view.size, CV_32FC4)
{}

RenderedFrame Microscope::expose(int frame, const ViewMotion& motion)
{
  RenderedFrame result;
  begin(frame, motion, result);
  result.tool = instrument_.at(result.t_s);
  light(result.t_s, result);
  if (result.tool.present) laser_.addSpot(picture_, result.tool.tip, result.frame);
  read(result);
  fire(result);
  if (!result.tool.present) result.tool.tip = {};
  return result;
}

RenderedFrame Microscope::expose(int frame, const ViewMotion& motion, const ToolInView& seen)
{
  RenderedFrame result;
  begin(frame, motion, result);
  result.tool = seen.tool;
  if (result.tool.shaft_width <= 0.0) result.tool.shaft_width = instrument_.width();
  light(result.t_s, result);
  laser_.addLight(picture_, seen.spot, seen.aiming, seen.flash);
  read(result);
  result.fired = seen.flash > 0.0;
  if (!result.tool.present) result.tool.tip = {};
  return result;
}

void Microscope::burn(cv::Point2d place_map) { laser_.burn(canvas_, place_map - map_origin_); }

void Microscope::begin(int frame, const ViewMotion& motion, RenderedFrame& result)
{
  result.frame = frame;
  result.t_s = frame / view_.fps;
  result.map_T_frame = motion.at(result.t_s);
  exposeRetina(result.t_s, motion);
  defocus(result.t_s);
}

// The mean over the exposure along the true motion, its middle at the frame's time.
void Microscope::exposeRetina(double t, const ViewMotion& motion)
{
  const double exposure = optics_.exposure_ms * 1e-3;
  const double moved = travel(motion.at(t - exposure / 2), motion.at(t), view_.size) +
                       travel(motion.at(t), motion.at(t + exposure / 2), view_.size);
  const int parts =
      std::clamp(static_cast<int>(std::ceil(moved / (kSubExposure_px * view_.px_scale))), 1, kMostSubExposures);
  for (int i = 0; i < parts; ++i) {
    const double instant = t + exposure * ((i + 0.5) / parts - 0.5);
    const ViewMapping mapping{motion.at(instant), motion.warpAt(instant), map_origin_};
    accumulateView(canvas_, mapping, {1.0F / static_cast<float>(parts), i == 0}, picture_);
  }
}

void Microscope::defocus(double t)
{
  const double change = optics_.defocus_change_px * std::sin(kTwoPi * 0.09 * t + focus_phase_);
  const double sigma = std::max(0.0, optics_.defocus_px + change) * view_.px_scale;
  if (sigma > 0.15) cv::GaussianBlur(picture_, picture_, {}, sigma, sigma, cv::BORDER_REPLICATE);
}

void Microscope::light(double t, RenderedFrame& result)
{
  const InstrumentPose& tool = result.tool;
  illumination_.lightAt(t, light_);
  instrument_.castShadow(tool, light_);
  const cv::Vec4f white(static_cast<float>(optics_.white_blue), static_cast<float>(optics_.white_green),
                        static_cast<float>(optics_.white_red), 0.0F);
  const auto veil = static_cast<float>(optics_.veil);
  for (int y = 0; y < picture_.rows; ++y) {
    auto* pixel = picture_.ptr<cv::Vec4f>(y);
    for (int x = 0; x < picture_.cols; ++x) pixel[x] = pixel[x].mul(white * light_(y, x)) + cv::Vec4f::all(veil);
  }
  const int covered = instrument_.draw(tool, illumination_.field(), picture_);
  result.tool_cover = static_cast<double>(covered) / static_cast<double>(view_.size.area());
}

void Microscope::read(RenderedFrame& result)
{
  blooms_.addTo(picture_, result.t_s);
  const double on = illumination_.switchedOn(result.t_s);
  result.visible = on >= kSeen;
  sensor_.read(picture_, illumination_.field(), static_cast<float>(on), result.image);
}

// After the frame: the retina whitens while the pulse goes on, so the burn shows from the next frame.
void Microscope::fire(RenderedFrame& result)
{
  if (!laser_.fires(result.frame) || !result.tool.present) return;
  const Eigen::Vector2d centre((view_.size.width - 1) / 2.0, (view_.size.height - 1) / 2.0);
  const Eigen::Vector2d tip(result.tool.tip.x, result.tool.tip.y);
  const Eigen::Vector2d map = centre + result.map_T_frame * (tip - centre);
  burn({map.x(), map.y()});
  result.fired = true;
}

}  // namespace eyeslam::simulation
