// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/camera_registration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "support/allocation_counter.h"

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::servo::CameraRegistration;
using eyeslam::servo::RetinaPlane;
using eyeslam::servo::TipSample;

namespace {

constexpr double kUmPerPx = 5.0;

/// A camera that looks along z, turned, 5 um per px, the middle of its picture at the manipulator's origin.
Eigen::Matrix<double, 2, 4> trueCamera(double turn = 0.3, double um_per_px = kUmPerPx)
{
  Eigen::Matrix<double, 2, 4> camera;
  const double px_per_m = 1e6 / um_per_px;
  camera << px_per_m * std::cos(turn), -px_per_m * std::sin(turn), 0.05 * px_per_m, 400.0,  //
      px_per_m * std::sin(turn), px_per_m * std::cos(turn), -0.08 * px_per_m, 300.0;
  return camera;
}

/// Tips over 3 x 3 x 0.4 mm, as the calibration of the study has them.
class World {
 public:
  explicit World(unsigned seed) : random_(seed) {}

  Eigen::Vector3d place() { return {1.5e-3 * across(), 1.5e-3 * across(), 0.2e-3 * across()}; }
  TipSample sampleAt(const Eigen::Vector3d& tip, double tip_noise = 4e-6, double image_noise = 1.0)
  {
    TipSample sample;
    sample.tip = tip + tip_noise * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
    sample.image_px = camera * tip.homogeneous();
    sample.image_px += image_noise * Eigen::Vector2d(normal_(random_), normal_(random_));
    return sample;
  }
  std::vector<TipSample> samples(int count)
  {
    std::vector<TipSample> samples;
    for (int i = 0; i < count; ++i) samples.push_back(sampleAt(place()));
    return samples;
  }

  Eigen::Matrix<double, 2, 4> camera = trueCamera();

 private:
  double across() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
};

/// RMS over held-out places of where a tip is seen against where it is, um on the retina.
double errorUm(const CameraRegistration& registration, World& world)
{
  double squares = 0.0;
  constexpr int kPlaces = 200;
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector3d tip = world.place();
    squares += (registration.result().toImage(tip) - world.camera * tip.homogeneous()).squaredNorm();
  }
  return kUmPerPx * std::sqrt(squares / kPlaces);
}

// The study reached 1.24 um with a spread of 0.31; the bound is the issue's.
TEST(CameraRegistration, IsWithinTwoMicrometresOfTruthAfter200Samples)
{
  double sum = 0.0, worst = 0.0;
  constexpr int kDraws = 100;
  for (unsigned seed = 0; seed < kDraws; ++seed) {
    World world(seed);
    CameraRegistration registration;
    ASSERT_EQ(registration.fit(world.samples(200)), Reason::none);
    const double error = errorUm(registration, world);
    sum += error;
    worst = std::max(worst, error);
  }
  RecordProperty("mean_um", std::to_string(sum / kDraws));
  EXPECT_LT(sum / kDraws, 2.0);
  EXPECT_LT(worst, 4.0);
}

TEST(CameraRegistration, OneByOneIsAsGoodAsAllAtOnce)
{
  World world(1);
  CameraRegistration registration;
  for (const TipSample& sample : world.samples(400)) registration.add(sample);
  EXPECT_EQ(registration.result().reason, Reason::none);
  EXPECT_LT(errorUm(registration, world), 3.0);
}

TEST(CameraRegistration, OneWrongDetectionInTenDoesNoHarm)
{
  World world(2);
  std::vector<TipSample> samples = world.samples(200);
  for (std::size_t i = 0; i < samples.size(); i += 10) samples[i].image_px += Eigen::Vector2d(60.0, -35.0);
  CameraRegistration registration;
  EXPECT_EQ(registration.fit(samples), Reason::none);
  EXPECT_LT(errorUm(registration, world), 2.5);
  EXPECT_GE(registration.refused(), 18);
}

TEST(CameraRegistration, ItsCovarianceIsHonest)
{
  double sum = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    World world(seed);
    CameraRegistration registration;
    std::vector<TipSample> samples = world.samples(60);
    for (TipSample& sample : samples) sample.sigma_px = std::hypot(1.0, 4.0 / kUmPerPx);
    registration.fit(samples);
    for (int i = 0; i < 5; ++i, ++count) {
      const Eigen::Vector3d tip = world.place();
      const double error = (registration.result().toImage(tip) - world.camera * tip.homogeneous()).norm();
      sum += std::pow(error / registration.result().sigmaOf(tip), 2) / 2.0;
    }
  }
  EXPECT_NEAR(sum / count, 1.0, 0.25);
}

TEST(CameraRegistration, RefusesTooFewTipsAndTipsOnALine)
{
  World world(3);
  CameraRegistration registration;
  EXPECT_EQ(registration.fit(world.samples(10)), Reason::not_registered);
  std::vector<TipSample> line;
  for (int i = 0; i < 200; ++i) line.push_back(world.sampleAt({1e-5 * i, 0.0, 0.0}, 0.0));
  EXPECT_EQ(registration.fit(line), Reason::registration_uncertain);
}

TEST(CameraRegistration, RefusesTipsThatNoCameraSees)
{
  World world(4);
  std::vector<TipSample> samples = world.samples(200);
  for (TipSample& sample : samples) sample.image_px = 8.0 * Eigen::Vector2d::Random() + sample.image_px;
  CameraRegistration registration;
  EXPECT_EQ(registration.fit(samples), Reason::registration_residual);
}

TEST(CameraRegistration, NoticesADriftThatItCannotFollow)
{
  World world(5);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  world.camera.col(3) += Eigen::Vector2d(20.0, 0.0);  // 100 um at once: the eye's lens was touched
  int samples = 0;
  while (registration.result().good() && samples < 100) {
    registration.add(world.sampleAt(world.place()));
    ++samples;
  }
  EXPECT_EQ(registration.result().reason, Reason::registration_drift);
  EXPECT_LE(samples, 30) << "a second of frames";
}

TEST(CameraRegistration, FollowsASlowDrift)
{
  World world(6);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  for (int i = 0; i < 3000; ++i) {
    world.camera.col(3).x() += 0.001;  // 15 um in 100 s
    registration.add(world.sampleAt(world.place()));
  }
  EXPECT_EQ(registration.result().reason, Reason::none);
  EXPECT_LT(errorUm(registration, world), 8.0);
}

TEST(CameraRegistration, RefusesAScaleThatDiffersFromTheDeclaredOne)
{
  World world(7);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  const RetinaPlane plane{-Eigen::Vector3d::UnitZ(), 0.0, 0.0};
  ASSERT_TRUE(registration.result().umPerPx(plane));
  EXPECT_NEAR(*registration.result().umPerPx(plane), kUmPerPx, 0.02);
  registration.expectScale(1.02 * kUmPerPx, plane);
  EXPECT_EQ(registration.result().reason, Reason::none);
  registration.expectScale(1.05 * kUmPerPx, plane);
  EXPECT_EQ(registration.result().reason, Reason::registration_scale);
}

TEST(CameraRegistration, ATipAtRestDoesNotMakeItForget)
{
  World world(8);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  const double sigma = registration.result().sigmaOf({1e-3, 1e-3, 0.0});
  for (int i = 0; i < 10000; ++i) registration.add(world.sampleAt({0.0, 0.0, 0.0}));
  EXPECT_LT(registration.result().sigmaOf({1e-3, 1e-3, 0.0}), 1.5 * sigma);
}

TEST(CameraRegistration, RefusesWhatIsNotFinite)
{
  World world(9);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  const Eigen::Matrix<double, 2, 4> before = registration.result().image_T_base;
  TipSample sample = world.sampleAt({1e-3, 0.0, 0.0});
  sample.image_px.x() = NAN;
  EXPECT_EQ(registration.add(sample), Reason::not_finite);
  sample = world.sampleAt({1e-3, 0.0, 0.0});
  sample.tip.z() = INFINITY;
  EXPECT_EQ(registration.add(sample), Reason::not_finite);
  EXPECT_EQ(registration.result().image_T_base, before);
}

TEST(CameraRegistration, AnImagePointGoesToThePlaneAndBack)
{
  World world(10);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.2, -1.0).normalized();
  const RetinaPlane plane{normal, 2e-4, 0.0};
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d image(8.0 * i, 6.0 * i);
    const auto point = registration.result().toPlane(image, plane);
    ASSERT_TRUE(point);
    EXPECT_NEAR(plane.height(*point), 0.0, 1e-12);
    EXPECT_LT((registration.result().toImage(*point) - image).norm(), 1e-6);
  }
}

TEST(CameraRegistration, AllocatesNothingInTheLoop)
{
  World world(11);
  CameraRegistration registration;
  registration.fit(world.samples(200));
  const TipSample sample = world.sampleAt({1e-3, 0.0, 0.0});
  const std::int64_t before = support::allocations();
  registration.add(sample);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
