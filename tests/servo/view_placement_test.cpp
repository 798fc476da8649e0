// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/view_placement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

using namespace eyeslam::servo;

namespace {

/// Cameras above a plane, both turned and shifted at random, the manipulator's frame wherever it likes.
class RandomSight {
 public:
  explicit RandomSight(unsigned seed) : random_(seed)
  {
    const Eigen::Matrix3d manipulator_R_world =
        Eigen::Quaterniond(axis(), axis(), axis(), axis()).normalized().matrix();
    plane.normal = manipulator_R_world * -Eigen::Vector3d::UnitZ();  // the world's z goes into the retina
    plane.distance = 0.1 * axis();
    um_per_px = 3.0 + 7.0 * std::abs(axis());
    // Image axes right and down as seen from above; the line of sight up to 15 deg off the plane's normal.
    Eigen::Matrix<double, 2, 3> of_world = Eigen::Matrix<double, 2, 3>::Zero();
    of_world.leftCols<2>() = Eigen::Rotation2Dd(3.0 * axis()).matrix() * 1e6 / um_per_px;
    of_world.col(2) = Eigen::Vector2d(axis(), axis()) * 0.25 * 1e6 / um_per_px;
    registration.image_T_base << of_world * manipulator_R_world.transpose(),
        Eigen::Vector2d(1e3 * axis(), 1e3 * axis());
    scale = {um_per_px * (1.0 + 0.02 * axis()), {640.0, 480.0}};  // the nominal scale need not be the true one
  }

  Eigen::Vector3d place() { return {3e-3 * axis(), 3e-3 * axis(), 3e-3 * axis()}; }

  Registration registration;
  RetinaPlane plane;
  double um_per_px;
  ViewScale scale;

 private:
  double axis() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937 random_;
};

}  // namespace

TEST(ViewPlacement, ThePictureOfAPlaceIsItsPixelsAtAnyHeight)
{
  for (unsigned seed = 0; seed < 500; ++seed) {
    RandomSight sight(seed);
    const auto placed = placeView(sight.registration, sight.plane, sight.scale);
    ASSERT_TRUE(placed);
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d view = sight.place();
      const Eigen::Vector2d image = sight.registration.toImage(placed->manipulator_T_view * view);
      EXPECT_LT((image - view.head<2>() / (1e-6 * sight.scale.um_per_px)).norm(), 1e-6);
    }
    EXPECT_LT((placed->centre - 1e-6 * sight.scale.um_per_px * sight.scale.centre_px).norm(), 1e-12);
  }
}

TEST(ViewPlacement, HeightAboveTheRetinaIsMinusZ)
{
  for (unsigned seed = 0; seed < 500; ++seed) {
    RandomSight sight(seed);
    const auto placed = placeView(sight.registration, sight.plane, sight.scale);
    ASSERT_TRUE(placed);
    const Eigen::Vector3d view = sight.place();
    EXPECT_NEAR(sight.plane.height(placed->manipulator_T_view * view), -view.z(), 1e-12);
  }
}

TEST(ViewPlacement, IsRightHandedWithZIntoTheRetinaForACameraThatLooksFromTheInstrumentsSide)
{
  for (unsigned seed = 0; seed < 500; ++seed) {
    RandomSight sight(seed);
    const auto placed = placeView(sight.registration, sight.plane, sight.scale);
    ASSERT_TRUE(placed);
    const Eigen::Matrix3d axes = placed->manipulator_T_view.linear();
    EXPECT_GT(axes.determinant(), 0.0);
    EXPECT_NEAR(sight.plane.normal.dot(axes.col(2)), -1.0, 1e-9);
    // Along the line of sight: it shows in one pixel.
    EXPECT_LT((sight.registration.image_T_base.leftCols<3>() * axes.col(2)).norm() * 1e-3, 1e-6);
  }
}

TEST(ViewPlacement, IsRefusedWhereTheCameraLooksAlongThePlaneOrTheScaleIsUnknown)
{
  RandomSight sight(1);
  ViewScale unknown = sight.scale;
  unknown.um_per_px = 0.0;
  EXPECT_FALSE(placeView(sight.registration, sight.plane, unknown));
  RetinaPlane along = sight.plane;
  along.normal = sight.registration.image_T_base.row(0).head<3>().normalized();
  EXPECT_FALSE(placeView(sight.registration, along, sight.scale));
  Registration nowhere = sight.registration;
  nowhere.image_T_base(0, 0) = std::nan("");
  EXPECT_FALSE(placeView(nowhere, sight.plane, sight.scale));
}
