// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/contrast_picture.h"

#include <opencv2/imgproc.hpp>

namespace eyeslam::baselines {

void makeContrastPicture(const tracking::Frame& frame, const tracking::OcclusionMask& mask, cv::Mat& picture,
                         cv::Mat& visible)
{
  constexpr double kGain = 500.0 / tracking::Frame::kContrastUnit;
  frame.contrast().convertTo(picture, CV_8U, kGain, 128.0);
  const cv::Mat shown = mask.cells() == tracking::OcclusionMask::kVisible;
  cv::resize(shown, visible, {}, tracking::Frame::kCell, tracking::Frame::kCell, cv::INTER_NEAREST);
  visible = visible(cv::Rect({0, 0}, picture.size()));
}

}  // namespace eyeslam::baselines
