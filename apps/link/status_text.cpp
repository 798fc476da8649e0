// SPDX-License-Identifier: GPL-3.0-or-later
#include "link/status_text.h"

#include <fmt/format.h>

#include "eyeslam/retina/reason.h"

namespace eyeslam::apps {
namespace {

std::string ageText(double seconds) { return seconds < 0.0 ? "never" : fmt::format("{:.0f} ms", 1e3 * seconds); }

// "2 expired, 1 replayed", or nothing.
std::string refusedText(const messaging::Refusals& refused)
{
  std::string text;
  for (std::size_t i = 0; i < refused.size(); ++i) {
    if (refused[i] == 0) continue;
    const auto reason =
        static_cast<retina::Reason>(static_cast<int>(retina::Reason::unauthenticated) + static_cast<int>(i));
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", refused[i], retina::word(reason));
  }
  return text.empty() ? "none" : text;
}

}  // namespace

std::string stateText(const messaging::ServoStatus& status)
{
  if (status.reason == retina::Reason::none) return std::string(messaging::word(status.state));
  return fmt::format("{}: {}", messaging::word(status.state), retina::word(status.reason));
}

std::string statusText(const messaging::ServoStatus& status)
{
  return fmt::format(
      "state      {}{}\n"
      "heard      pose {} ago, controller {}, laser {}, operator {}\n"
      "timing     frame to command {}, computation {:.0f} us, latest start {:.2f} ms\n"
      "counts     {} cycles, {} left out, {} messages lost, refused: {}",
      stateText(status), status.real_time ? ", in real time" : ", not in real time", ageText(status.pose_age),
      ageText(status.state_age), ageText(status.laser_age), ageText(status.operator_age),
      ageText(status.frame_to_command), 1e6 * status.computation, 1e3 * status.lateness, status.cycles, status.overruns,
      status.messages_lost, refusedText(status.messages_refused));
}

std::string registrationText(const messaging::PublishedRegistration& registration)
{
  if (!registration.valid) {
    return fmt::format("not registered: {} ({} tips)", retina::word(registration.reason), registration.samples);
  }
  return fmt::format("registered: {} tips, {:.2f} px, {:.2f} um/px", registration.samples, registration.residual_px,
                     registration.um_per_px);
}

}  // namespace eyeslam::apps
