// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes behind the fingerprint of any type: accepted, or refused for a counted reason. The first byte picks the
// type, the rest is sent in pieces of the length that its next two bytes say.
#include <cstdlib>
#include <numeric>
#include <vector>

#include "support/every_subscription.h"

using namespace eyeslam;
using namespace eyeslam::messaging;

namespace {

template <class Message>
std::int64_t fingerprint()
{
  return Message::getHash();
}

/// Of the types in the order of EverySubscription::all().
constexpr std::int64_t (*kFingerprints[])() = {
    fingerprint<burn_plan_t>,    fingerprint<laser_command_t>,  fingerprint<laser_state_t>,
    fingerprint<mark_t>,         fingerprint<micron_command_t>, fingerprint<micron_state_t>,
    fingerprint<operator_t>,     fingerprint<registration_t>,   fingerprint<retina_pose_t>,
    fingerprint<servo_status_t>, fingerprint<tool_tip_t>,       fingerprint<vessel_map_t>};

std::vector<std::uint8_t> withFingerprint(std::size_t type, const std::uint8_t* bytes, std::size_t size)
{
  const auto bits = static_cast<std::uint64_t>(kFingerprints[type]());
  std::vector<std::uint8_t> message;
  for (int shift = 56; shift >= 0; shift -= 8) message.push_back(static_cast<std::uint8_t>(bits >> shift));
  message.insert(message.end(), bytes, bytes + size);
  return message;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static Link link("memq://", 1, {});
  if (size < 3) return 0;
  support::EverySubscription subscriptions{link, {}};
  const std::size_t type = bytes[0] % subscriptions.all().size();
  ChannelReceiver& channel = *subscriptions.all()[type];
  const std::size_t piece = 1 + bytes[1] * std::size_t{256} + bytes[2];
  for (std::size_t at = 3; at < size; at += piece) {
    const std::vector<std::uint8_t> message = withFingerprint(type, bytes + at, std::min(piece, size - at));
    link.send(channel.channel(), message.data(), message.size());
  }
  link.drain({1'700'000'000'000'000, 1'700'000'000'000'000});
  const Refusals& refused = channel.refused();
  if (std::accumulate(refused.begin(), refused.end(), channel.accepted()) != channel.received()) std::abort();
  if (channel.refused(retina::Reason::internal_error) != 0) std::abort();
  return 0;
}
