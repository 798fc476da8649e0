// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/eye_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/retina_motion.h"

namespace eyeslam::simulation {
namespace {

constexpr std::uint64_t kSeed = 5;

EyeCameraOptions small()
{
  EyeCameraOptions options;
  options.width = 320;
  options.height = 240;
  return options;
}

const Fundus& fundus()
{
  static const Fundus retina = [] {
    ProceduralFundusOptions options;
    options.um_per_px = umPerPx(small(), kSeed);
    return proceduralFundus(options, kSeed);
  }();
  return retina;
}

/// A scene in which everything moves evenly.
class Scene {
 public:
  explicit Scene(const EyeCameraOptions& options) : options_(options), shutter_(options, kSeed) {}

  SceneNow at(double t) const
  {
    const double m = umPerPx(options_, kSeed) * 1e-6;
    SceneNow scene;
    scene.world_T_retina.centre = {159.5 * m, 119.5 * m, 0.0};
    scene.world_T_retina.shift = speed * t;
    scene.world_T_retina.theta = 0.02 * t;
    scene.tip = Eigen::Vector3d(150 * m, 100 * m, -3e-4) + speed * t;
    scene.shaft = Eigen::Vector3d(0.4, -0.3, -std::sqrt(0.75));
    scene.spot = scene.tip - 3e-4 / 0.75 * scene.shaft;
    scene.aiming = aiming;
    scene.emitting = emitting;
    return scene;
  }
  FrameDue frame(int number)
  {
    for (;; t_ms_ += 1) {
      shutter_.expose(at(1e-3 * t_ms_));
      auto due = shutter_.due();
      if (due && due->frame == number) {
        ++t_ms_;
        return *due;
      }
    }
  }
  const Eigen::Vector2d& picture() const { return shutter_.picture(); }

  Eigen::Vector3d speed = Eigen::Vector3d(1e-3, -5e-4, 0.0);
  bool aiming = false, emitting = false;

 private:
  EyeCameraOptions options_;
  FrameShutter shutter_;
  int t_ms_ = 0;
};

/// Where two pictures differ, px.
struct Change {
  cv::Point2d middle, spread;  ///< mean and standard deviation
};

Change changeOf(const cv::Mat_<cv::Vec3b>& a, const cv::Mat_<cv::Vec3b>& b)
{
  double sum = 0.0;
  cv::Point2d first, second;
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      const double weight = std::max(0, std::abs(a(y, x)[1] - b(y, x)[1]) - 8);  // brighter light has more noise
      sum += weight;
      first += weight * cv::Point2d(x, y);
      second += weight * cv::Point2d(x * x, y * y);
    }
  }
  EXPECT_GT(sum, 100.0);
  const cv::Point2d middle = first / std::max(sum, 1.0);
  const cv::Point2d square = second / std::max(sum, 1.0);
  return {middle, {std::sqrt(square.x - middle.x * middle.x), std::sqrt(square.y - middle.y * middle.y)}};
}

TEST(FrameShutter, TheToolIsWhereItWasInTheMiddleOfTheExposure)
{
  EyeCameraOptions options = small();
  options.drift_um = 0.0;
  Scene scene(options);
  const FrameDue due = scene.frame(3);
  EXPECT_NEAR(due.t_s, 0.1, 1e-12);
  const double m = umPerPx(options, kSeed) * 1e-6;
  const SceneNow middle = scene.at(0.1);
  EXPECT_NEAR(due.tool.tool.tip.x, middle.tip.x() / m, 1e-6);
  EXPECT_NEAR(due.tool.tool.tip.y, middle.tip.y() / m, 1e-6);
  EXPECT_NEAR(due.tool.spot.x, middle.spot.x() / m, 1e-6);
  // It points down the shaft, to the left and down in the image.
  EXPECT_NEAR(std::cos(due.tool.tool.shaft_angle), -0.8, 1e-9);
  EXPECT_NEAR(std::sin(due.tool.tool.shaft_angle), 0.6, 1e-9);
}

TEST(FrameShutter, RetinaAndToolWanderTogetherInThePicture)
{
  EyeCameraOptions options = small();
  options.drift_s = 0.5;
  Scene scene(options), still([&] {
    EyeCameraOptions without = options;
    without.drift_um = 0.0;
    return without;
  }());
  const FrameDue due = scene.frame(20);
  const FrameDue reference = still.frame(20);
  const double m = umPerPx(options, kSeed) * 1e-6;
  const Eigen::Vector2d wandered = scene.picture() / m;  // at the end of the exposure, not its middle
  EXPECT_GT(wandered.norm(), 0.1);
  const cv::Point2d tool = due.tool.tool.tip - reference.tool.tool.tip;
  EXPECT_NEAR(tool.x, wandered.x(), 0.3);
  EXPECT_NEAR(tool.y, wandered.y(), 0.3);
  // map = c + R (frame - c) + t: a picture that goes right shows tissue that lies farther left.
  const Eigen::Vector2d change = due.view.at(due.t_s).translation() - reference.view.at(due.t_s).translation();
  EXPECT_NEAR(change.x(), -tool.x, 0.1);
  EXPECT_NEAR(change.y(), -tool.y, 0.1);
}

TEST(FrameShutter, ThePictureWandersByItsDrift)
{
  EyeCameraOptions options = small();
  options.drift_s = 0.1;
  FrameShutter shutter(options, kSeed);
  double square = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    shutter.expose({});
    square += shutter.picture().squaredNorm() / 2.0;
  }
  EXPECT_NEAR(std::sqrt(square / 60'000), 15e-6, 2e-6);
}

TEST(EyeCamera, TheTruthOfAFrameIsTheRetinasInTheMiddleOfItsExposure)
{
  EyeCameraOptions options = small();
  options.drift_um = 0.0;
  EyeCamera camera(options, fundus(), kSeed);
  Scene scene(options);
  const RenderedFrame rendered = camera.render(scene.frame(6));
  const retina::Pose2 expected = viewPose(scene.at(0.2).world_T_retina, {159.5, 119.5}, camera.umPerPx());
  EXPECT_NEAR(rendered.map_T_frame.x, expected.x, 1e-3);
  EXPECT_NEAR(rendered.map_T_frame.y, expected.y, 1e-3);
  EXPECT_NEAR(rendered.map_T_frame.theta, expected.theta, 1e-9);
  EXPECT_TRUE(rendered.tool.present);
  EXPECT_GT(rendered.tool.shaft_width, 5.0);
}

TEST(EyeCamera, TheSpotShinesWhereTheBeamMeetsTheRetina)
{
  EyeCamera dark(small(), fundus(), kSeed), lit(small(), fundus(), kSeed), bright(small(), fundus(), kSeed);
  Scene scene(small());
  FrameDue due = scene.frame(4);
  const RenderedFrame without = dark.render(due);
  due.tool.aiming = 1.0;
  const cv::Point2d aimed = changeOf(lit.render(due).image, without.image).middle;
  EXPECT_NEAR(aimed.x, due.tool.spot.x, 0.5);
  EXPECT_NEAR(aimed.y, due.tool.spot.y, 0.5);
  due.tool.aiming = 0.0;
  due.tool.flash = 1.0;
  const RenderedFrame flashed = bright.render(due);
  EXPECT_TRUE(flashed.fired);
  const cv::Point2d fired = changeOf(flashed.image, without.image).middle;
  EXPECT_NEAR(fired.x, due.tool.spot.x, 0.5);
  EXPECT_NEAR(fired.y, due.tool.spot.y, 0.5);
}

/// What a burn at a place of the map changes in a frame.
Change burnSeen(FrameDue due, const cv::Point2d& place_map)
{
  due.tool.tool.tip = {-5000.0, 5000.0};  // out of sight
  due.tool.tool.present = false;
  EyeCamera whole(small(), fundus(), kSeed), burnt(small(), fundus(), kSeed);
  const RenderedFrame before = whole.render(due);
  due.burns_map = {place_map};
  return changeOf(burnt.render(due).image, before.image);
}

TEST(EyeCamera, BurnsStayAtTheirPlaceOfTheRetina)
{
  Scene scene(small());
  const Eigen::Vector2d centre(159.5, 119.5);
  for (const int frame : {0, 30}) {  // the frames between are left out
    const FrameDue due = scene.frame(frame);
    for (const Eigen::Vector2d& burn : {Eigen::Vector2d(90.0, 150.0), Eigen::Vector2d(130.0, 100.0)}) {
      const cv::Point2d seen = burnSeen(due, {burn.x(), burn.y()}).middle;
      const Eigen::Vector2d map = centre + due.view.at(due.t_s) * (Eigen::Vector2d(seen.x, seen.y) - centre);
      EXPECT_LT((map - burn).norm(), 0.7);
    }
  }
}

TEST(EyeCamera, BurnsOfFramesThatWereLeftOutAreSeenLater)
{
  Scene scene(small());
  EyeCamera every(small(), fundus(), kSeed), some(small(), fundus(), kSeed);
  FrameDue first = scene.frame(0), second = scene.frame(1);
  first.burns_map = {{90.0, 150.0}};
  second.burns_map = {{90.0, 150.0}, {130.0, 100.0}};
  every.render(first);
  every.render(second);
  some.render(second);
  second.frame = 2;
  EXPECT_LT(cv::norm(every.render(second).image, some.render(second).image, cv::NORM_INF), 30.0);  // noise alone
}

TEST(EyeCamera, AStuckCameraGivesThePictureBeforeOnceMore)
{
  EyeCamera camera(small(), fundus(), kSeed);
  Scene scene(small());
  const RenderedFrame first = camera.render(scene.frame(0));
  FrameDue due = scene.frame(1);
  due.repeats = true;
  const RenderedFrame stuck = camera.render(due);
  EXPECT_EQ(stuck.frame, 1);
  EXPECT_EQ(cv::norm(first.image, stuck.image, cv::NORM_INF), 0.0);
  due.repeats = false;
  EXPECT_GT(cv::norm(first.image, camera.render(due).image, cv::NORM_INF), 0.0);
}

TEST(EyeCamera, TheSameFramesGiveTheSamePicturesToTheByte)
{
  EyeCamera once(small(), fundus(), kSeed), again(small(), fundus(), kSeed);
  Scene scene(small());
  scene.aiming = true;
  for (int k = 0; k < 3; ++k) {
    const FrameDue due = scene.frame(k);
    EXPECT_EQ(cv::norm(once.render(due).image, again.render(due).image, cv::NORM_INF), 0.0);
  }
}

TEST(EyeCamera, AFastRetinaIsBlurredAlongItsWay)
{
  const auto spread = [](const Eigen::Vector3d& speed) {
    Scene scene(small());
    scene.speed = speed;
    return burnSeen(scene.frame(1), {110.0, 130.0}).spread;
  };
  const cv::Point2d still = spread({0.0, 0.0, 0.0});
  const cv::Point2d fast = spread({0.02, 0.0, 0.0});
  const double way = 0.02 * 0.008 / (umPerPx(small(), kSeed) * 1e-6);  // px during the exposure, some 12
  const double widened = std::sqrt(fast.x * fast.x - still.x * still.x);
  EXPECT_LT(widened, 1.1 * way / std::sqrt(12.0));
  EXPECT_GT(widened, 0.6 * way / std::sqrt(12.0));  // its faint ends do not count as a change
  EXPECT_NEAR(fast.y, still.y, 0.3);
}

// A retina that is black but for a white square of 0.2 mm and a vessel as wide beside it.
Fundus markedFundus(const cv::Point2d& mark_mm)
{
  Fundus fundus;
  fundus.um_per_px = 5.0;
  fundus.bgr.create(1880, 2800);
  fundus.bgr.setTo(cv::Vec3f(0.05F, 0.05F, 0.05F));
  fundus.calibre_px.create(fundus.bgr.size());
  fundus.calibre_px.setTo(0.0F);
  fundus.known.create(fundus.bgr.size());
  fundus.known.setTo(255);
  const cv::Rect square(cvRound(200.0 * mark_mm.x) - 20, cvRound(200.0 * mark_mm.y) - 20, 41, 41);
  fundus.bgr(square).setTo(cv::Vec3f(0.9F, 0.9F, 0.9F));
  fundus.calibre_px(square).setTo(8.0F);
  return fundus;
}

cv::Point2d middleOf(const cv::Mat& mask)
{
  const cv::Moments moments = cv::moments(mask, true);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

TEST(EyeCamera, BeginsWhereItIsToldTo)
{
  for (const cv::Point2d& place_mm : {cv::Point2d(5.0, 4.0), cv::Point2d(8.5, 5.5)}) {
    EyeCameraOptions options = small();
    options.drift_um = 0.0;
    options.view_x_mm = place_mm.x;
    options.view_y_mm = place_mm.y;
    const EyeCamera camera(options, markedFundus(place_mm), kSeed);
    // On the vessels, in map px, whose frame 0 is the picture at the start.
    const cv::Point2d at = middleOf(camera.vessels() > 0.0F) + camera.vesselsOrigin();
    EXPECT_NEAR(at.x, imageCentre(options).x, 1.0);
    EXPECT_NEAR(at.y, imageCentre(options).y, 1.0);
  }
}

TEST(EyeCamera, ShowsInItsPictureThePlaceThatItBeginsAt)
{
  EyeCameraOptions options = small();
  options.drift_um = 0.0;
  options.view_x_mm = 6.0;
  options.view_y_mm = 4.5;
  EyeCamera camera(options, markedFundus({6.0, 4.5}), kSeed);
  Scene scene(options);
  scene.speed.setZero();
  const RenderedFrame frame = camera.render(scene.frame(0));
  // The tool's dark shaft is beside it: the square is far brighter than all else but blooms.
  const double um = umPerPx(options, kSeed);
  const int half = static_cast<int>(60.0 / um);
  const cv::Point2d centre = imageCentre(options);
  const cv::Rect inside(cvRound(centre.x) - half, cvRound(centre.y) - half, 2 * half, 2 * half);
  const int far = static_cast<int>(300.0 / um);
  const cv::Rect below(cvRound(centre.x) - half, cvRound(centre.y) + far, 2 * half, 2 * half);
  EXPECT_GT(cv::mean(frame.image(inside))[1], 2.0 * cv::mean(frame.image(below))[1]);
}

TEST(EyeCamera, PaintsTheRetinaInTheSamePlaceAsItsVessels)
{
  EyeCameraOptions options = small();
  options.view_x_mm = 6.0;
  options.view_y_mm = 4.5;
  const EyeCamera camera(options, markedFundus({6.3, 4.2}), kSeed);
  ASSERT_EQ(camera.retina().size(), camera.vessels().size());
  ASSERT_EQ(camera.retina().type(), CV_8UC3);
  cv::Mat green;
  cv::extractChannel(camera.retina(), green, 1);
  const cv::Point2d seen = middleOf(green > 128), vessel = middleOf(camera.vessels() > 0.0F);
  EXPECT_LT(std::hypot(seen.x - vessel.x, seen.y - vessel.y), 1.5);  // calibres are those of the nearest px
}

TEST(EyeCamera, RefusesAFundusThatIsTooSmallForTheViewAndItsReach)
{
  EyeCameraOptions options = small();
  options.reach_mm = 10.0;
  EXPECT_THROW(EyeCamera(options, fundus(), kSeed), std::invalid_argument);
  options.condition = "moon";
  EXPECT_THROW(EyeCamera(options, fundus(), kSeed), std::invalid_argument);
}

}  // namespace
}  // namespace eyeslam::simulation
