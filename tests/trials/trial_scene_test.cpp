// SPDX-License-Identifier: GPL-3.0-or-later
// Where the surgeon puts the retina before a trial.
#include "eyeslam/trials/trial_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "eyeslam/simulation/eye_camera.h"
#include "support/short_trial.h"

namespace {

using namespace eyeslam;

constexpr std::uint64_t kSeed = 19;  // a reflection lies over the vessel where it is put in the middle of the view

trials::TrialScene scene(const std::string& yaml) { return *support::ShortTrial(yaml, kSeed).scene; }

Eigen::Vector2d view(const trials::TrialScene& scene)
{
  return 1e-3 * Eigen::Vector2d(scene.camera().view_x_mm, scene.camera().view_y_mm);
}

double onVessel(const trials::TrialScene& scene)
{
  double farthest = 0.0;
  for (const Eigen::Vector3d& place : scene.path())
    farthest = std::max(farthest, scene.vesselDistance(place.head<2>()));
  return farthest;
}

// Places of the path under reflections with the view turned by so much, m.
std::ptrdiff_t hidden(const trials::TrialScene& scene, const Eigen::Vector2d& turn)
{
  const simulation::SpecularBlooms blooms = simulation::specularBlooms(scene.camera(), kSeed);
  const cv::Point2d centre = simulation::imageCentre(scene.camera());
  return std::count_if(scene.path().begin(), scene.path().end(), [&](const Eigen::Vector3d& place) {
    const Eigen::Vector2d px = ((place - scene.middle()).head<2>() - turn) / (1e-6 * scene.umPerPx());
    return blooms.mayHide(centre + cv::Point2d(px.x(), px.y()), 0.0);
  });
}

TEST(TrialScene, IsTurnedUntilNoReflectionLiesOverTheVesselToFollow)
{
  const trials::TrialScene traced = scene("task: trace"), held = scene("task: hold");
  EXPECT_EQ(hidden(traced, Eigen::Vector2d::Zero()), 0);
  EXPECT_GT(hidden(traced, view(held) - view(traced)), 0) << "nothing lay over it, so that this proves nothing";
  EXPECT_EQ(onVessel(traced), 0.0);
}

TEST(TrialScene, HasThePathOnItsVesselWhereverTheViewIsPut)
{
  const trials::TrialScene chosen = scene("task: trace");
  const Eigen::Vector2d elsewhere = view(chosen) + Eigen::Vector2d(0.3e-3, -0.2e-3);
  trials::TrialSetting setting =
      support::ShortTrial("task: trace", kSeed, std::make_shared<const trials::TrialScene>(chosen)).setting;
  setting.hardware.camera.view_x_mm = 1e3 * elsewhere.x();
  setting.hardware.camera.view_y_mm = 1e3 * elsewhere.y();
  const trials::TrialScene put(setting, kSeed);
  ASSERT_EQ(put.path().size(), chosen.path().size());
  EXPECT_LT((view(put) - elsewhere).norm(), 1e-12);
  EXPECT_EQ(onVessel(put), 0.0);
  for (const Eigen::Vector3d& place : put.path()) EXPECT_LT(put.centrelineDistance(place.head<2>()), 1e-9);
}

}  // namespace
