// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "eyeslam/replay/comparison.h"
#include "eyeslam/replay/sorted_log.h"
#include "eyeslam/replay/video_replay.h"

namespace eyeslam::apps {

/// For people: a line a channel, where it differs first, then each field that differs.
/// @param start  us since 1970, of the log's first event
std::string comparisonText(const replay::Comparison& comparison, std::int64_t start);

/// One line: how many messages differ, and where the first of them is.
std::string differenceText(const replay::Comparison& comparison, std::int64_t start);

/// For programs (contracts, section 7), with the first differences and the fields besides.
/// @param video  that the tracker was computed from, or null
std::string comparisonJson(const replay::Comparison& comparison, const replay::SortedLog& log,
                           const replay::VideoReplay* video, bool interrupted);
/// The same of a log that could not be computed again.
std::string failureJson(const std::string& what);

}  // namespace eyeslam::apps
