// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/track_window.h"

#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImageConvert.h>

#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "command_line/program.h"
#include "eyeslam/tracking/eyeslam_tracker.h"
#include "eyeslam/tracking/track_display.h"

namespace eyeslam::apps {
namespace {

// Eight-bit BGR of whatever the tracker takes.
cv::Mat shownImage(const cv::Mat& image)
{
  cv::Mat shown = image;
  if (shown.depth() == CV_16U) shown.convertTo(shown, CV_8U, 1.0 / 257.0);
  if (shown.channels() == 1) cv::cvtColor(shown, shown, cv::COLOR_GRAY2BGR);
  return shown;
}

}  // namespace

TrackWindow::TrackWindow()
{
  const char* const screen = std::getenv("DISPLAY");
  if (screen == nullptr || *screen == '\0') {
    throw UsageError("--display: there is no screen (DISPLAY is not set); leave it out, or start a desktop");
  }
}

void TrackWindow::open()
{
  try {
    window_.init(image_, 100, 100, "eyeslam-track");
  } catch (const vpException&) {
    throw UsageError(std::string("--display: the screen ") + std::getenv("DISPLAY") +
                     " cannot be opened; leave it out");
  }
}

void TrackWindow::onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                          baselines::Method& method)
{
  vpImageConvert::convert(shownImage(frame.image), image_);  // of one size for all frames, as a ViSP window needs
  if (!window_.isInitialised()) open();
  const tracking::EyeSlamTracker* const tracker = method.eyeSlam();
  vpDisplay::display(image_);
  tracking::displayTrack(image_, method.vesselMap(), result, tracker ? tracker->getToolTip() : tracking::ToolTip{},
                         vpColor::cyan, 1);
  vpDisplay::flush(image_);
}

}  // namespace eyeslam::apps
