// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "eyeslam/messaging/link.h"
#include "eyeslam/simulation/hardware.h"

namespace eyeslam::examples {

/// Which manipulator an example drives.
struct MicronChoice {
  std::string url, key;
  bool simulate = false;
};
void addOptions(CLI::App& app, MicronChoice& choice);

/// A manipulator over LCM, whose time is the computer's; or a simulated one in a trembling hand, whose time is stepped.
class MicronConnection {
 public:
  /// @throws std::runtime_error  URL or key cannot be used
  explicit MicronConnection(const MicronChoice& choice);

  messaging::Link& link() { return link_; }
  messaging::ReceiveTime now() const;
  /// Lets a camera's frame go by, 33 ms.
  void waitForFrame();

 private:
  std::int64_t session_;
  messaging::Link link_;
  messaging::ReceiveTime simulated_{1'000'000, 1'700'000'000'000'000};
  std::optional<simulation::Hardware> hardware_;
};

}  // namespace eyeslam::examples
