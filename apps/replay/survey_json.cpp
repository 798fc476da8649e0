// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command_line/version.h"
#include "replay/survey_text.h"

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::apps {
namespace {

using nlohmann::json;
using servo::seconds;

json gapJson(const replay::LongestGap& gap) { return {{"s", seconds(gap.us)}, {"at_s", seconds(gap.since_us)}}; }

json statisticsJson(const replay::DurationStatistics& durations)
{
  if (durations.count() == 0) return nullptr;
  return {{"lowest", 1e-3 * static_cast<double>(durations.lowest())},
          {"mean", 1e-3 * durations.mean()},
          {"median", 1e-3 * durations.quantile(0.5)},
          {"p99", 1e-3 * durations.quantile(0.99)},
          {"highest", 1e-3 * static_cast<double>(durations.highest())}};
}

json channelJson(const replay::ChannelFindings& channel)
{
  json object = {{"name", channel.channel},
                 {"type", channel.type.empty() ? json() : json(channel.type)},
                 {"events", channel.events},
                 {"bytes", channel.bytes},
                 {"rate_per_s", channel.rate},
                 {"longest_gap", gapJson(channel.gap)},
                 {"refused", {{"changed_type", channel.changed_type}, {"undecodable", channel.undecodable}}}};
  if (channel.fingerprint) {
    object["fingerprint"] = fmt::format("{:016x}", static_cast<std::uint64_t>(*channel.fingerprint));
  }
  if (channel.changed_type > 0) object["migration"] = replay::migrationOf(channel.type);
  if (channel.sessions == 0) return object;
  object["sessions"] = channel.sessions;
  object["lost"] = channel.lost;
  object["repeated"] = channel.repeated;
  object["overtaken"] = channel.overtaken;
  object["times"] = {{"missing", channel.utime_missing},
                     {"backwards", channel.utime_backwards},
                     {"from_future", channel.from_future},
                     {"sent_later", channel.sent_later}};
  object["age_ms"] = statisticsJson(channel.age);
  object["transport_ms"] = statisticsJson(channel.transport);
  return object;
}

json markJson(const replay::LoggedMark& logged)
{
  const mark_t& mark = logged.mark;
  return {{"at_s", seconds(logged.since_us)},
          {"kind", mark.kind},
          {"session", mark.session},
          {"sender", mark.sender},
          {"version", mark.version},
          {"configuration", mark.configuration},
          {"configuration_hash", mark.configuration_hash},
          {"note", mark.note}};
}

json damageJson(const replay::LogSurvey& survey)
{
  return {{"skipped_bytes", survey.damage.skipped_bytes}, {"places", survey.damage.gaps},
          {"first_offset", survey.damage.first_offset},   {"cut_off", survey.damage.cut_off},
          {"out_of_order", survey.damage.out_of_order},   {"late", survey.times.late},
          {"latest_s", seconds(survey.times.latest_us)},  {"strays", survey.times.strays},
          {"steps_back", survey.times.steps_back}};
}

}  // namespace

std::string surveyJson(const replay::LogSurvey& survey, const std::string& path)
{
  json object = {{"version", kVersion},
                 {"log", path},
                 {"bytes", survey.file_bytes},
                 {"events", survey.events},
                 {"start_utime", survey.start},
                 {"duration_s", seconds(survey.end - survey.start)},
                 {"longest_gap", gapJson(survey.gap)},
                 {"damage", damageJson(survey)},
                 {"channels", json::array()},
                 {"events_on_more_channels", survey.left_out},
                 {"marks", json::array()},
                 {"marks_left_out", survey.marks_left_out}};
  for (const replay::ChannelFindings& channel : survey.channels) object["channels"].push_back(channelJson(channel));
  for (const replay::LoggedMark& mark : survey.marks) object["marks"].push_back(markJson(mark));
  // Names and notes may hold any bytes.
  return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace eyeslam::apps
