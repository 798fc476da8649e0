// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/mosaic_picture.h"

#include <gtest/gtest.h>

#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::arc;
using support::DrawnRetina;
using support::PreparedFrame;

constexpr int kWidth = 160, kHeight = 120;  // frame px
constexpr int kMargin = 2;                  // the mosaic leaves out what cubic samples cannot reach

class Seen {
 public:
  void show(const cv::Mat& photo, const Pose2& pose)
  {
    const PreparedFrame view(photo);
    if (mosaic_.empty()) {
      mosaic_.start({view.frame, view.mask});
    } else {
      for (int number = 0; number < 8; ++number) mosaic_.blend({view.frame, view.mask}, pose, 20.0, number);
    }
    picture_.observe(view.frame, view.mask, mosaic_.centre(), pose);
  }
  cv::Mat draw(cv::Point& corner) const { return picture_.draw(mosaic_, corner); }

 private:
  Mosaic mosaic_;
  MosaicPicture picture_;
};

// A frame pixel as the mean of the photograph's four.
cv::Vec3d halved(const cv::Mat& photo, int x, int y)
{
  const cv::Scalar mean = cv::mean(photo(cv::Rect(2 * x, 2 * y, 2, 2)));
  return {mean[0], mean[1], mean[2]};
}

TEST(MosaicPicture, HasTheFramesColours)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(arc({80.0, 60.0}, 0.4, 0.0, 300.0), 4.0, 0.2);
  const cv::Mat photo = retina.photograph(0.0, 1);
  Seen seen;
  seen.show(photo, {});
  cv::Point corner;
  const cv::Mat picture = seen.draw(corner);
  ASSERT_EQ(picture.type(), CV_8UC3);
  ASSERT_EQ(corner, cv::Point(kMargin, kMargin));
  ASSERT_EQ(picture.size(), cv::Size(kWidth - 2 * kMargin, kHeight - 2 * kMargin));
  double worst = 0.0, sum = 0.0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3d off = cv::Vec3d(picture.at<cv::Vec3b>(y, x)) - halved(photo, x + corner.x, y + corner.y);
      worst = std::max(worst, std::abs(off[1]));
      sum += std::abs(off[0]) + std::abs(off[1]) + std::abs(off[2]);
    }
  }
  // Green of 80, 64 in the vessel, whose edges [1 2 1] smooths; red and blue follow by a share only.
  EXPECT_LT(worst, 10.0);
  EXPECT_LT(sum / (3.0 * static_cast<double>(picture.total())), 2.5);
}

TEST(MosaicPicture, ShowsWhereItsCornerLiesInTheMosaic)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(arc({40.0, 60.0}, M_PI / 2, 0.0, 300.0), 4.0, 0.3);
  const cv::Mat photo = retina.photograph(0.0, 1);
  Seen seen;
  seen.show(photo, {});
  seen.show(photo, {-200.0, 150.0});
  seen.show(photo, {190.0, -130.0});
  cv::Point corner;
  const cv::Mat picture = seen.draw(corner);
  EXPECT_EQ(corner, cv::Point(-200 + kMargin, -130 + kMargin));
  EXPECT_EQ(picture.size(), cv::Size(200 + kWidth + 190 - 2 * kMargin, 130 + kHeight + 150 - 2 * kMargin));
  // The vessel's column in the three frames: the darkest of its surroundings.
  const auto green = [&](const cv::Point& mosaic) { return picture.at<cv::Vec3b>(mosaic - corner)[1]; };
  for (const cv::Point& vessel : {cv::Point(40, 45), cv::Point(-160, 200), cv::Point(230, -90)}) {
    EXPECT_LT(green(vessel), green(vessel - cv::Point(6, 0)) - 10) << vessel;
    EXPECT_LT(green(vessel), green(vessel + cv::Point(6, 0)) - 10) << vessel;
  }
}

TEST(MosaicPicture, IsBlackWhereNothingWasEverSeen)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.bloom({60.0, 60.0}, 5.0);
  Seen seen;
  seen.show(retina.photograph(0.0, 1), {});
  seen.show(DrawnRetina(kWidth, kHeight).photograph(0.0, 1), {200.0, 90.0});
  cv::Point corner;
  const cv::Mat picture = seen.draw(corner);
  const auto at = [&](int x, int y) { return picture.at<cv::Vec3b>(cv::Point(x, y) - corner); };
  EXPECT_EQ(at(60, 60), cv::Vec3b());   // under the bloom
  EXPECT_EQ(at(300, 20), cv::Vec3b());  // beside the second view
  EXPECT_EQ(at(20, 180), cv::Vec3b());  // below the first
  EXPECT_NE(at(120, 60), cv::Vec3b());
  EXPECT_NE(at(300, 150), cv::Vec3b());
}

TEST(MosaicPicture, DrawsNothingOfAnEmptyMosaic)
{
  cv::Point corner;
  EXPECT_TRUE(MosaicPicture().draw(Mosaic(), corner).empty());
}

}  // namespace
}  // namespace eyeslam::tracking
