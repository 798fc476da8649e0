// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/channel_guard.h"

#include <algorithm>
#include <cstdlib>

namespace eyeslam::messaging {
namespace {

using retina::Reason;

// Up to the year 2112, so that no difference of two times overflows.
constexpr std::int64_t kLatestUtime = std::int64_t{1} << 52;

bool plausible(const MessageHeader& header)
{
  return header.utime >= 0 && header.utime < kLatestUtime && header.utime_sent > 0 &&
         header.utime_sent < kLatestUtime && header.seq >= 0 && header.session != 0;
}

}  // namespace

Reason ChannelGuard::admit(const MessageHeader& header, const ReceiveTime& now, std::optional<double> expiry)
{
  if (!plausible(header)) return Reason::out_of_range;
  if (header.session != session_) {
    if (!mayHear(header.session)) return Reason::wrong_session;
    if (std::abs(now.utime - header.utime_sent) > kFirstContact_us) return Reason::clock_differs;
    listenTo(header.session);
  }
  open_ = false;
  if (const Reason why = order_.admit(header.seq); why != Reason::none) return why;
  if (!clock_.follows(header.utime_sent, now.monotonic)) return fault_ = Reason::clock_stepped;
  const double age = 1e-6 * static_cast<double>(now.monotonic - clock_.toReceiver(header.utime_sent));
  return expiry && !(age <= *expiry) ? Reason::expired : Reason::none;
}

Reason ChannelGuard::admitAnyone(const MessageHeader& header, const ReceiveTime& now)
{
  if (!plausible(header)) return Reason::out_of_range;
  session_ = header.session;
  clock_.forget();
  clock_.follows(header.utime_sent, now.monotonic);
  return Reason::none;
}

bool ChannelGuard::mayHear(std::int64_t session) const
{
  return open_ && std::find(past_.begin(), past_.end(), session) == past_.end();
}

void ChannelGuard::listenTo(std::int64_t session)
{
  past_[replaced_++ % past_.size()] = session_;
  session_ = session;
  lost_ += order_.lost();
  order_ = SequenceWindow();
}

void ChannelGuard::acceptNewSession()
{
  open_ = true;
  clock_.forget();
  fault_ = Reason::none;
}

}  // namespace eyeslam::messaging
