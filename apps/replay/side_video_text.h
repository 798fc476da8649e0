// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/replay/video_replay.h"
#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// Where a log's video is, whether there is one or not.
std::string videoBeside(const ReplayArguments& arguments);

/// The video that belongs to a log: the one that was named, else `video.mkv` in the log's folder; empty where there is
/// none, or nobody asks for the tracker.
/// @throws UsageError  --only tracker or --offset without a video
std::string videoOf(const ReplayArguments& arguments);

/// The same where one must be. @throws UsageError
std::string requiredVideoOf(const ReplayArguments& arguments);

/// How far video and log are apart, and what should be looked at; lines for people.
std::string videoText(const replay::VideoReplay& video);

}  // namespace eyeslam::apps
