// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/messaging/servo_messages.h"

namespace eyeslam::apps {

/// "hold: pose_stale"; the reason only where there is one.
std::string stateText(const messaging::ServoStatus& status);

/// All of a status for people: state, ages, times, counts; some lines.
std::string statusText(const messaging::ServoStatus& status);

/// "registered: 812 tips, 0.9 px, 5.02 um/px", or why not.
std::string registrationText(const messaging::PublishedRegistration& registration);

}  // namespace eyeslam::apps
