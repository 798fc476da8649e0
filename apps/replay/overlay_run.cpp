// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/overlay_run.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "command_line/program.h"
#include "eyeslam/files/encoded_video.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/replay/logged_scene.h"
#include "eyeslam/replay/message_types.h"
#include "eyeslam/replay/scene_picture.h"
#include "eyeslam/replay/side_video.h"
#include "replay/log_pass.h"
#include "replay/side_video_text.h"

namespace eyeslam::apps {
namespace {

constexpr int kQuality = 18;  // crf of H.264: fine vessels are kept

// A frame is drawn once its pose and its tip are known.
class OverlayRun {
 public:
  explicit OverlayRun(const ReplayArguments& arguments)
      : arguments_(arguments),
        selection_(selectionOf(arguments)),
        pass_(arguments, "drawing"),
        video_(requiredVideoOf(arguments)),
        file_(arguments.out)
  {
    video_.setShift(std::llround(arguments.offset.value_or(0.0) * video_.framesPerSecond()));
  }

  void run()
  {
    while (const auto event = pass_.nextOfToday()) {
      const bool pose = event->event.channel == "RETINA_POSE" && isOfThisRun(*event) && mayFollow(*event);
      if (pose) drawWaiting();
      scene_.take(*event);
      if (pose) waiting_ = Waiting{replay::headerOf(event->event).seq, event->since_us, selection_.takes(*event)};
      if (event->event.channel == "TOOL_TIP" && isWaitedFor(*event)) drawWaiting();
    }
    drawWaiting();
    finish();
  }

 private:
  struct Waiting {
    std::int64_t pose = 0, since_us = 0;
    bool taken = false;
  };

  // The video is of the tracker's first run.
  bool isOfThisRun(const replay::SortedEvent& event)
  {
    if (replay::judge(event.event).standing != replay::Standing::ours) return false;
    const std::int64_t session = replay::headerOf(event.event).session;
    if (session_ == 0) session_ = session;
    return session == session_;
  }

  bool mayFollow(const replay::SortedEvent& event) const
  {
    const std::int64_t pose = replay::headerOf(event.event).seq, last = waiting_ ? waiting_->pose : next_ - 1;
    return last < 0 || pose - last <= replay::SideVideo::kMostLost;
  }

  bool isWaitedFor(const replay::SortedEvent& event)
  {
    return waiting_ && isOfThisRun(event) && replay::headerOf(event.event).seq == waiting_->pose;
  }

  void drawWaiting()
  {
    if (!waiting_) return;
    const Waiting due = *waiting_;
    waiting_.reset();
    for (; next_ < due.pose && !video_.ended(); ++next_) draw({next_, due.since_us, due.taken && written_ > 0}, false);
    draw(due, true);
    next_ = due.pose + 1;
  }

  void draw(const Waiting& due, bool known)
  {
    const cv::Mat& image = video_.pictureOf(due.pose);
    if (image.empty() || !due.taken) return;
    const std::int64_t utime = known && scene_.pose() ? scene_.pose()->frame.utime : 0;
    const std::int64_t since_us = known && utime > 0 ? utime - pass_.log().start() : due.since_us;
    const cv::Mat& picture = picture_.draw(image, due.pose, 1e-6 * static_cast<double>(since_us), scene_, known);
    if (!encoded_)
      encoded_.emplace(file_.partialPath(), arguments_.out, picture.size(), video_.framesPerSecond(), kQuality);
    encoded_->add(picture);
    ++written_;
  }

  void finish()
  {
    pass_.end();
    if (written_ == 0) {
      throw files::FileError(
          fmt::format("{}: no RETINA_POSE with a picture in this part; nothing written", arguments_.log));
    }
    encoded_->close();
    file_.publish();
    if (!video_.failure().empty()) fmt::print(stderr, "eyeslam-replay: {}\n", video_.failure());
    if (pass_.interrupted()) fmt::print(stderr, "eyeslam-replay: interrupted; {} ends there\n", arguments_.out);
    if (!arguments_.quiet) fmt::print("{}: {} frames\n", arguments_.out, written_);
  }

  const ReplayArguments& arguments_;
  replay::LogSelection selection_;
  LogPass pass_;
  replay::SideVideo video_;
  files::PartialFile file_;
  std::optional<files::EncodedVideo> encoded_;
  replay::LoggedScene scene_;
  replay::ScenePicture picture_;
  std::optional<Waiting> waiting_;
  std::int64_t session_ = 0, next_ = 0, written_ = 0;
};

}  // namespace

void drawLog(const ReplayArguments& arguments) { OverlayRun(arguments).run(); }

}  // namespace eyeslam::apps
