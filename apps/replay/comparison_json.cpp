// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include "command_line/version.h"
#include "replay/comparison_text.h"

namespace eyeslam::apps {
namespace {

using nlohmann::ordered_json;

// Texts may hold any bytes.
std::string textOf(const ordered_json& object)
{
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

// JSON has no infinity.
ordered_json numberJson(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json("infinite"); }

ordered_json firstJson(const replay::FirstDifference& first)
{
  return {{"utime", first.utime},
          {"event", first.event},
          {"field", first.field},
          {"recorded", first.recorded},
          {"recomputed", first.recomputed}};
}

ordered_json fieldJson(const replay::FieldDifference& field)
{
  return {{"name", field.field},
          {"messages", field.messages},
          {"max_difference", numberJson(field.largest)},
          {"rms_difference", numberJson(field.rms)}};
}

ordered_json channelJson(const replay::ChannelComparison& channel)
{
  ordered_json object = {
      {"name", channel.channel},
      {"compared", channel.compared},
      {"identical", channel.identical},
      {"first_difference_utime", channel.first ? ordered_json(channel.first->utime) : ordered_json()},
      {"max_difference", numberJson(channel.largest)},
      {"missing", channel.missing},
      {"extra", channel.extra},
      {"first_difference", channel.first ? firstJson(*channel.first) : ordered_json()},
      {"fields", ordered_json::array()}};
  for (const replay::FieldDifference& field : channel.fields) object["fields"].push_back(fieldJson(field));
  return object;
}

ordered_json videoJson(const replay::VideoReplay& video)
{
  const replay::TrackerFindings found = video.findings();
  ordered_json object = {{"pictures", video.video().pictures()},
                         {"tracked_again", found.frames},
                         {"poses_without_picture", found.missing},
                         {"pictures_without_pose", found.lost},
                         {"bad_times", found.times_missing + found.times_repeated + found.times_backwards},
                         {"shift_frames", video.shift()},
                         {"offset_s", nullptr}};
  if (const std::optional<replay::OffsetEstimate>& offset = video.offset()) {
    object["offset_s"] = offset->offset_s;
    object["offset_sigma_s"] = offset->sigma_s;
    object["advised_offset_s"] = *video.advisedOffset();
    object["offset_frames"] = offset->frames();
    object["offset_correlation"] = offset->correlation;
    object["offset_correlation_elsewhere"] = offset->second;
    object["offset_certain"] = offset->isCertain();
  }
  object["warnings"] = video.warnings();
  return object;
}

}  // namespace

std::string comparisonJson(const replay::Comparison& comparison, const replay::SortedLog& log,
                           const replay::VideoReplay* video, bool interrupted)
{
  ordered_json object = {{"version", kVersion},
                         {"events", log.reader().events()},
                         {"skipped", log.reader().damage().skipped_bytes},
                         {"interrupted", interrupted},
                         {"video", video == nullptr ? ordered_json() : videoJson(*video)},
                         {"channels", ordered_json::array()}};
  for (const replay::ChannelComparison& channel : comparison.channels())
    object["channels"].push_back(channelJson(channel));
  return textOf(object);
}

std::string failureJson(const std::string& what) { return textOf({{"version", kVersion}, {"error", what}}); }

}  // namespace eyeslam::apps
