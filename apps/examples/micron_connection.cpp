// SPDX-License-Identifier: GPL-3.0-or-later
#include "examples/micron_connection.h"

#include <chrono>
#include <thread>

#include "eyeslam/messaging/authentication.h"
#include "link/program_link.h"

namespace eyeslam::examples {

void addOptions(CLI::App& app, MicronChoice& choice)
{
  app.add_option("--lcm", choice.url, "where the controller is heard; default LCM_DEFAULT_URL");
  app.add_option("--key", choice.key, "signs the commands")->check(CLI::ExistingFile);
  app.add_flag("--simulate", choice.simulate, "a simulated manipulator in a trembling hand, within this program");
}

MicronConnection::MicronConnection(const MicronChoice& choice)
    : session_(apps::newSession()),
      link_(choice.simulate ? "memq://" : choice.url, session_,
            choice.key.empty() ? std::nullopt : std::make_optional(messaging::readKey(choice.key)))
{
  if (choice.simulate)
    hardware_.emplace(simulation::HardwareOptions{}, simulation::holdPlace({0.0, 0.0, -0.5e-3}), link_, session_);
}

messaging::ReceiveTime MicronConnection::now() const { return hardware_ ? simulated_ : apps::receiveTime(); }

void MicronConnection::waitForFrame()
{
  constexpr int kFrame_ms = 33;
  if (!hardware_) return std::this_thread::sleep_for(std::chrono::milliseconds(kFrame_ms));
  for (int i = 0; i < kFrame_ms; ++i) {
    simulated_.monotonic += 1000;
    simulated_.utime += 1000;
    link_.drain(simulated_);
    hardware_->step(simulated_);
  }
}

}  // namespace eyeslam::examples
