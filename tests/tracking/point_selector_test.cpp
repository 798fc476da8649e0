// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/point_selector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/allocation_counter.h"

using namespace eyeslam;
using namespace eyeslam::tracking;

namespace {

const Eigen::Vector2d kCentre(199.5, 151.5);

VesselPoint pointAt(float x, float y)
{
  VesselPoint point;
  point.x = x;
  point.y = y;
  return point;
}

VesselPoints randomPoints(std::mt19937& random, int count)
{
  std::uniform_real_distribution<float> x(0.0F, 399.0F), y(0.0F, 303.0F);
  VesselPoints points;
  for (int n = 0; n < count; ++n) points.push_back(pointAt(x(random), y(random)));
  return points;
}

bool isAmong(const Eigen::Vector2f& chosen, const VesselPoints& points)
{
  return std::any_of(points.begin(), points.end(), [&](const VesselPoint& point) {
    return chosen.x() == static_cast<float>(point.x - kCentre.x()) &&
           chosen.y() == static_cast<float>(point.y - kCentre.y());
  });
}

TEST(PointSelector, ChoosesDifferentPointsOfThoseGivenAndNeverTooMany)
{
  std::mt19937 random(1);
  PointSelector selector;
  ScanPoints chosen;
  for (const int count : {0, 1, 7, 499, 500, 501, 1500}) {
    const VesselPoints points = randomPoints(random, count);
    selector.choose(points, kCentre, chosen);
    EXPECT_EQ(chosen.size(), static_cast<std::size_t>(std::min(count, 500)));
    for (const Eigen::Vector2f& point : chosen) EXPECT_TRUE(isAmong(point, points));
    const auto before = [](const auto& a, const auto& b) {
      return std::make_pair(a.x(), a.y()) < std::make_pair(b.x(), b.y());
    };
    std::sort(chosen.begin(), chosen.end(), before);
    EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
  }
}

TEST(PointSelector, SpreadsOverTheViewHoweverCrowdedACornerIs)
{
  std::mt19937 random(2);
  VesselPoints points;
  std::uniform_real_distribution<float> corner(0.0F, 31.0F);
  for (int n = 0; n < 2000; ++n) points.push_back(pointAt(corner(random), corner(random)));
  for (int n = 1; n < 9; ++n) points.push_back(pointAt(32.0F * static_cast<float>(n) + 5.0F, 200.0F));
  PointSelector selector;
  ScanPoints chosen;
  selector.choose(points, kCentre, 20, chosen);
  int alone = 0;
  for (const Eigen::Vector2f& point : chosen) alone += point.y() == static_cast<float>(200.0 - kCentre.y()) ? 1 : 0;
  EXPECT_EQ(alone, 8);  // every point that is alone in its square
  EXPECT_EQ(chosen.size(), 20U);
}

TEST(PointSelector, ChoosesTheSameForTheSameSeed)
{
  std::mt19937 random(3);
  const VesselPoints points = randomPoints(random, 900);
  PointSelectorOptions other_options;
  other_options.seed = 2;
  PointSelector first, second, other(other_options);
  ScanPoints a, b, c, again;
  first.choose(points, kCentre, a);
  second.choose(points, kCentre, b);
  other.choose(points, kCentre, c);
  first.choose(points, kCentre, again);
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
  EXPECT_NE(a, again);  // a frame's choice is not the last one's
  first.restart();
  first.choose(points, kCentre, again);
  EXPECT_EQ(a, again);
}

TEST(PointSelector, LeavesOutWhatIsNotFinite)
{
  PointSelector selector;
  ScanPoints chosen;
  selector.choose({pointAt(NAN, 1.0F), pointAt(3.0F, HUGE_VALF), pointAt(1e30F, -1e30F), pointAt(9.0F, 9.0F)}, kCentre,
                  chosen);
  EXPECT_EQ(chosen.size(), 2U);
}

TEST(PointSelector, AllocatesNothingOnceItHasSeenAsManyPoints)
{
  std::mt19937 random(4);
  const VesselPoints many = randomPoints(random, 900), fewer = randomPoints(random, 800);
  PointSelector selector;
  ScanPoints chosen;
  selector.choose(many, kCentre, chosen);
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 10; ++i) selector.choose(i % 2 == 0 ? fewer : many, kCentre, chosen);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
