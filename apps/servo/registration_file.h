// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/messaging/servo_messages.h"

namespace eyeslam::apps {

/// What REGISTRATION says as a file (JSON), so that a run can begin with the calibration of the last one.
/// @throws files::FileError naming the file and the field
messaging::PublishedRegistration readRegistration(const std::string& path);

/// Atomic. @throws files::FileError
void writeRegistration(const messaging::PublishedRegistration& registration, const std::string& path);

}  // namespace eyeslam::apps
