// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/channel_survey.h"

#include <algorithm>
#include <limits>

namespace eyeslam::replay {
namespace {

// Of counts that a hostile log may make as large as it likes.
std::int64_t sum(std::int64_t a, std::int64_t b)
{
  return a > std::numeric_limits<std::int64_t>::max() - b ? std::numeric_limits<std::int64_t>::max() : a + b;
}

}  // namespace

void ChannelSurvey::add(const SortedEvent& event, const JudgedEvent& judged)
{
  ++findings_.events;
  findings_.bytes += static_cast<std::int64_t>(event.event.size);
  if (!event.stray) timeOf(event);
  if (judged.type) findings_.type = judged.type->name;
  switch (judged.standing) {
    case Standing::ours:
      judgeHeader(headerOf(event.event), event);
      return;
    case Standing::changed_type:
      ++findings_.changed_type;
      break;
    case Standing::wrong_length:
      ++findings_.undecodable;
      return;
    case Standing::foreign:
      break;
  }
  if (!findings_.fingerprint) findings_.fingerprint = judged.fingerprint;
}

// A late event ends no gap, and a log that steps back begins none.
void ChannelSurvey::timeOf(const SortedEvent& event)
{
  const bool begins = timed_++ == 0 || event.part != part_;
  if (begins) ++parts_;
  part_ = event.part;
  if (event.late && !begins) return;
  const std::int64_t gap = begins ? 0 : event.since_us - last_since_;
  if (gap > findings_.gap.us) findings_.gap = {gap, last_since_};
  duration_us_ += gap;
  last_since_ = event.since_us;
}

void ChannelSurvey::judgeHeader(const messaging::MessageHeader& header, const SortedEvent& event)
{
  judgeOrder(header);
  if (header.utime <= 0 || header.utime_sent <= 0) {
    ++findings_.utime_missing;
    return;
  }
  Session& session = sessionOf(header.session);
  if (header.utime < session.utime) ++findings_.utime_backwards;
  session.utime = header.utime;
  findings_.age.add(header.utime_sent - header.utime);
  if (header.utime > header.utime_sent) ++findings_.from_future;
  if (event.stray) return;
  findings_.transport.add(event.event.utime - header.utime_sent);
  if (header.utime_sent - event.event.utime > kClock_us) ++findings_.sent_later;
}

void ChannelSurvey::judgeOrder(const messaging::MessageHeader& header)
{
  switch (sessionOf(header.session).order.admit(header.seq)) {
    case retina::Reason::replayed:
      ++findings_.repeated;
      break;
    case retina::Reason::out_of_order:
      ++findings_.overtaken;
      break;
    default:
      break;
  }
}

ChannelSurvey::Session& ChannelSurvey::sessionOf(std::int64_t id)
{
  const auto known = [id](const Session& session) { return session.last_heard >= 0 && session.id == id; };
  auto found = std::find_if(sessions_.begin(), sessions_.end(), known);
  if (found == sessions_.end()) {
    const auto earlier = [](const Session& a, const Session& b) { return a.last_heard < b.last_heard; };
    found = std::min_element(sessions_.begin(), sessions_.end(), earlier);
    lost_in_forgotten_ = sum(lost_in_forgotten_, found->order.lost());
    *found = {};
    found->id = id;
    ++findings_.sessions;
  }
  found->last_heard = findings_.events;
  return *found;
}

ChannelFindings ChannelSurvey::findings() const
{
  ChannelFindings findings = findings_;
  std::int64_t left_out = lost_in_forgotten_;
  for (const Session& session : sessions_) left_out = sum(left_out, session.order.lost());
  findings.lost = left_out - findings.overtaken;
  if (duration_us_ > 0)
    findings.rate = static_cast<double>(timed_ - parts_) / (1e-6 * static_cast<double>(duration_us_));
  return findings;
}

}  // namespace eyeslam::replay
