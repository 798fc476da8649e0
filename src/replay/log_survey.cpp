// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/log_survey.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"

namespace eyeslam::replay {

std::vector<ChannelFindings> LogSurvey::refused() const
{
  std::vector<ChannelFindings> all;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(all),
               [](const ChannelFindings& channel) { return channel.changed_type > 0; });
  return all;
}

void LogSurveyor::add(const SortedEvent& event)
{
  ++survey_.events;
  if (!event.stray && !event.late) timeOf(event);
  const JudgedEvent judged = judge(event.event);
  ChannelSurvey* channel = channelOf(event.event.channel);
  if (!channel) {
    ++survey_.left_out;
    return;
  }
  channel->add(event, judged);
  if (judged.standing == Standing::ours && judged.type->name == mark_t::getTypeName()) note(event);
}

// A log that steps back begins no gap there.
void LogSurveyor::timeOf(const SortedEvent& event)
{
  const std::int64_t gap = survey_.end == 0 ? 0 : event.since_us - last_since_;
  if (gap > survey_.gap.us) survey_.gap = {gap, last_since_};
  last_since_ = event.since_us;
  survey_.end = std::max(survey_.end, event.utime);
}

ChannelSurvey* LogSurveyor::channelOf(std::string_view name)
{
  if (const auto found = channels_.find(name); found != channels_.end()) return &found->second;
  if (channels_.size() >= kMostChannels && !typeOfChannel(name)) return nullptr;
  return &channels_.emplace(std::string(name), ChannelSurvey(std::string(name))).first->second;
}

void LogSurveyor::note(const SortedEvent& event)
{
  if (survey_.marks.size() >= kMostMarks) {
    ++survey_.marks_left_out;
    return;
  }
  LoggedMark logged{event.since_us, {}};
  if (messaging::decode(event.event.data, event.event.size, logged.mark)) survey_.marks.push_back(std::move(logged));
}

LogSurvey LogSurveyor::survey(const SortedLog& log) const
{
  LogSurvey survey = survey_;
  survey.file_bytes = log.reader().size();
  survey.start = log.start();
  survey.damage = log.reader().damage();
  survey.times = log.findings();
  for (const auto& [name, channel] : channels_) survey.channels.push_back(channel.findings());
  return survey;
}

std::string migrationOf(const std::string& type)
{
  return "there is no migration of " + type + " from another version: use the version that its MARK names";
}

}  // namespace eyeslam::replay
