// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/scene_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/sub_pixel.h"
#include "eyeslam/tracking/view_geometry.h"

namespace eyeslam::replay {
namespace {

const cv::Scalar kGround(26, 22, 20), kInk(236, 236, 236), kQuiet(165, 160, 154);
const cv::Scalar kVessel(235, 235, 110), kSight(255, 200, 60), kTip(255, 255, 255), kHand(120, 170, 255);
const cv::Scalar kGoal(255, 90, 255), kSpot(110, 255, 110), kWish(80, 220, 255), kZone(80, 80, 235);
const cv::Scalar kPending(80, 220, 255), kDone(250, 250, 250), kMissed(70, 70, 255), kRefused(150, 150, 150);
const cv::Scalar kGood(120, 220, 120), kBad(90, 90, 255);
constexpr int kLine = 24, kRim = 8;  // px of a line of text, and around all of them
constexpr int kSmall = 640;          // px: a frame less wide is enlarged
constexpr int kThreshold = 128;      // of a vessel (contracts, section 3)
constexpr double kFont = 0.45;

bool isNear(cv::Point2d at) { return std::abs(at.x) < 1e4 && std::abs(at.y) < 1e4; }

void line(cv::Mat& picture, cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness = 1)
{
  if (isNear(from) && isNear(to))
    cv::line(picture, tracking::inSubPixels(from), tracking::inSubPixels(to), colour, thickness, cv::LINE_AA,
             tracking::kSubPixelBits);
}

void ring(cv::Mat& picture, cv::Point2d centre, double radius, const cv::Scalar& colour, int thickness = 1)
{
  if (!isNear(centre) || !(radius < 1e4)) return;
  cv::circle(picture, tracking::inSubPixels(centre), cvRound(radius * (1 << tracking::kSubPixelBits)), colour,
             thickness, cv::LINE_AA, tracking::kSubPixelBits);
}

// Arms that leave the middle free.
void cross(cv::Mat& picture, cv::Point2d at, double from, double to, const cv::Scalar& colour, double turn = 0.0)
{
  for (int arm = 0; arm < 4; ++arm) {
    const double angle = turn + arm * kPi / 2.0;
    const cv::Point2d along(std::cos(angle), std::sin(angle));
    line(picture, at + from * along, at + to * along, colour, 2);
  }
}

cv::Point2d projected(const messaging::PublishedRegistration& registration, const Eigen::Vector3d& point)
{
  const Eigen::Vector2d px = registration.image_T_manipulator * point.homogeneous();
  return {px.x(), px.y()};
}

std::string fixtureText(const messaging::OperatorWish& wish)
{
  using messaging::FixtureKind;
  static constexpr const char* kNames[] = {"no fixture",      "tremor filter",     "motion scaling", "fixture: point",
                                           "fixture: vessel", "fixture: standoff", "calibration"};
  const messaging::WantedFixture& fixture = wish.fixture;
  std::string text = kNames[static_cast<int>(fixture.kind)];
  const bool bounds = fixture.kind == FixtureKind::point || fixture.kind == FixtureKind::vessel ||
                      fixture.kind == FixtureKind::standoff;
  if (bounds) text += fixture.lambda > 0.0 ? fmt::format(", soft {:g}", fixture.lambda) : ", hard";
  if (fixture.kind == FixtureKind::standoff) text += fmt::format(", {:.0f} um", 1e6 * fixture.standoff);
  return text;
}

std::string planText(const burn_plan_t& plan)
{
  const auto count = [&plan](std::int16_t state) {
    return std::count_if(plan.target.begin(), plan.target.end(),
                         [state](const burn_target_t& target) { return target.state == state; });
  };
  return fmt::format("burnt {} of {}{}", count(burn_target_t::DONE),
                     plan.targets - static_cast<int>(count(burn_target_t::REFUSED)),
                     plan.state == burn_plan_t::IN_FORCE ? "" : " proposed");
}

}  // namespace

const cv::Mat& ScenePicture::draw(const cv::Mat& image, std::int64_t number, double time_s, const LoggedScene& scene,
                                  bool known)
{
  layOut(image);
  if (known && scene.pose()) {
    image_T_map_ = tracking::inverse(tracking::mapFromImage(scene.pose()->motion.map_T_frame, size_));
    if (scene.pose()->motion.tracked) {
      drawVessels(scene);
      drawPlan(scene);
      drawWish(scene);
    }
    drawInstrument(scene);
    drawManipulator(scene);
  }
  writeState(number, time_s, scene, known);
  return canvas_;
}

void ScenePicture::layOut(const cv::Mat& image)
{
  size_ = image.size();
  enlarged_ = std::max(1, (kSmall + image.cols - 1) / image.cols);
  const cv::Size view(image.cols * enlarged_, image.rows * enlarged_);
  canvas_.create((view.height + 3 * kLine + 2 * kRim) & ~1, (view.width + 1) & ~1, CV_8UC3);
  canvas_.setTo(kGround);
  view_ = canvas_(cv::Rect({0, 0}, view));
  cv::Mat colour = image;
  if (image.channels() == 1) cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
  cv::resize(colour, view_, view, 0.0, 0.0, cv::INTER_LINEAR);
}

// Centres of pixels, contracts, section 1.
cv::Point2d ScenePicture::onCanvas(cv::Point2d image_px) const
{
  return {(image_px.x + 0.5) * enlarged_ - 0.5, (image_px.y + 0.5) * enlarged_ - 0.5};
}

// Tinted, with their edges: what lies beneath stays to be seen.
void ScenePicture::drawVessels(const LoggedScene& scene)
{
  const retina::VesselMap& map = scene.map();
  if (map.empty()) return;
  const cv::Mat grid(map.height, map.width, CV_8U, const_cast<std::uint8_t*>(map.probability.data()));
  const double k = enlarged_, half = (enlarged_ - 1) / 2.0;
  const cv::Matx23d cells(map.px_per_cell, 0.0, map.origin_x, 0.0, map.px_per_cell, map.origin_y);
  const cv::Matx23d enlarge(k, 0.0, half, 0.0, k, half);
  cv::warpAffine(grid, warped_, tracking::chain(enlarge, tracking::chain(image_T_map_, cells)), view_.size(),
                 cv::INTER_LINEAR);
  mask_ = warped_ >= kThreshold;
  cv::addWeighted(view_, 0.8, cv::Mat(view_.size(), CV_8UC3, kVessel), 0.2, 0.0, tint_);
  tint_.copyTo(view_, mask_);
  std::vector<std::vector<cv::Point>> edges;
  cv::findContours(mask_, edges, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  cv::drawContours(view_, edges, -1, kVessel, 1, cv::LINE_AA);
}

void ScenePicture::drawPlan(const LoggedScene& scene)
{
  const burn_plan_t* const plan = scene.plan();
  if (plan == nullptr || !(plan->um_per_px > 0.0)) return;
  for (const burn_target_t& target : plan->target) {
    const double radius = 0.5 * target.burn_um / plan->um_per_px * enlarged_;
    drawTarget(target, onCanvas(tracking::transformed(image_T_map_, {target.x_px, target.y_px})), radius);
  }
}

void ScenePicture::drawTarget(const burn_target_t& target, cv::Point2d at, double radius)
{
  switch (target.state) {
    case burn_target_t::PENDING:
      return ring(view_, at, radius, kPending);
    case burn_target_t::DONE:
      ring(view_, at, radius, kDone);
      return ring(view_, at, 1.5, kDone, -1);
    case burn_target_t::MISSED:
      ring(view_, at, radius, kMissed);
      return cross(view_, at, 0.0, radius, kMissed, kPi / 4.0);
    default:
      return ring(view_, at, 0.5 * radius, kRefused);
  }
}

void ScenePicture::drawWish(const LoggedScene& scene)
{
  if (!scene.wish()) return;
  const messaging::OperatorWish& wish = *scene.wish();
  for (int i = 0; i < wish.zones; ++i) {
    const messaging::Zone& zone = wish.zone[static_cast<std::size_t>(i)];
    for (int corner = 0; corner < zone.corners; ++corner) {
      const auto place = [&](int number) {
        const auto px = zone.corner_px.col(number % zone.corners);
        return onCanvas(tracking::transformed(image_T_map_, {px.x(), px.y()}));
      };
      line(view_, place(corner), place(corner + 1), kZone, 2);
    }
  }
  const Eigen::Vector2d& point = wish.fixture.point_px;
  if (point.isZero()) return;
  const cv::Point2d at = onCanvas(tracking::transformed(image_T_map_, {point.x(), point.y()}));
  ring(view_, at, 9.0, kWish, 2);
  ring(view_, at, 1.5, kWish, -1);
}

void ScenePicture::drawInstrument(const LoggedScene& scene)
{
  if (!scene.sight() || scene.sight()->frame.frame != scene.pose()->frame.frame) return;
  const messaging::InstrumentSight& sight = *scene.sight();
  if (sight.tip.present) {
    const cv::Point2d at = onCanvas({sight.tip.position_px.x(), sight.tip.position_px.y()});
    const cv::Point2d along(std::cos(sight.shaft_angle), std::sin(sight.shaft_angle));
    const cv::Point2d across(-along.y, along.x);
    const double half = 0.5 * sight.shaft_width_px * enlarged_;
    for (const double side : {-half, half})
      line(view_, at - 4.0 * half * along + side * across, at - 24.0 * half * along + side * across, kSight, 2);
    ring(view_, at, 6.0, kSight, 2);
  }
  if (!sight.spot.present) return;
  const cv::Point2d spot = onCanvas({sight.spot.position_px.x(), sight.spot.position_px.y()});
  cross(view_, spot, 5.0, 12.0, scene.emitting() ? kMissed : kSpot);
}

void ScenePicture::drawManipulator(const LoggedScene& scene)
{
  const messaging::MicronState* const state = scene.stateAt(scene.pose()->frame.utime);
  if (state == nullptr || !scene.registration()) return;
  const messaging::PublishedRegistration& registration = *scene.registration();
  const cv::Point2d hand = onCanvas(projected(registration, state->null.position));
  const cv::Point2d tip = onCanvas(projected(registration, state->tip.position));
  line(view_, hand, tip, kHand);
  ring(view_, hand, 4.0, kHand, 2);
  if (state->follows_command) cross(view_, onCanvas(projected(registration, state->goal)), 2.0, 9.0, kGoal, kPi / 4.0);
  ring(view_, tip, 2.0, kTip, -1);
}

int ScenePicture::write(const std::string& text, int x, int line_number, const cv::Scalar& colour)
{
  const int y = view_.rows + kRim + line_number * kLine + 16;
  cv::putText(canvas_, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, kFont, colour, 1, cv::LINE_AA);
  int baseline = 0;
  return x + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFont, 1, &baseline).width + 18;
}

void ScenePicture::writeState(std::int64_t number, double time_s, const LoggedScene& scene, bool known)
{
  using messaging::ServoState;
  int x = write(fmt::format("{:.2f} s", time_s), 12, 0, kInk);
  x = write(fmt::format("frame {}", number), x, 0, kQuiet);
  if (!known || !scene.pose()) {
    write("no pose in the log", x, 0, kBad);
  } else if (const messaging::RetinaMotion& motion = scene.pose()->motion; motion.tracked) {
    write(fmt::format("tracked   x {:+.1f}  y {:+.1f} px   turn {:+.2f} deg", motion.map_T_frame.x,
                      motion.map_T_frame.y, motion.map_T_frame.theta * 180.0 / kPi),
          x, 0, kGood);
  } else {
    write(fmt::format("lost: {}", retina::word(motion.reason)), x, 0, kBad);
  }
  x = 12;
  if (const auto& status = scene.status()) {
    const bool stopped = status->state == ServoState::hold || status->state == ServoState::fault;
    std::string text = fmt::format("servo: {}", word(status->state));
    if (status->reason != retina::Reason::none) text += fmt::format(" ({})", retina::word(status->reason));
    x = write(text, x, 1, stopped ? kBad : kInk);
  }
  if (scene.wish()) x = write(fixtureText(*scene.wish()), x, 1, kWish);
  if (scene.plan() != nullptr) write(planText(*scene.plan()), x, 1, kPending);
  x = 12;
  const std::pair<const char*, const cv::Scalar&> legend[] = {
      {"published vessels", kVessel}, {"instrument seen", kSight}, {"tip", kTip}, {"hand", kHand}, {"goal", kGoal},
      {"aiming spot", kSpot}};
  for (const auto& [word, colour] : legend) x = write(word, x, 2, colour);
}

}  // namespace eyeslam::replay
