// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/interruption.h"

#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace eyeslam::apps {
namespace {

sigset_t endingSignals()
{
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

void setBlocked(int how)
{
  const sigset_t signals = endingSignals();
  pthread_sigmask(how, &signals, nullptr);
}

}  // namespace

Interruption::Interruption()
{
  setBlocked(SIG_BLOCK);
  const sigset_t signals = endingSignals();
  descriptor_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
  if (descriptor_ < 0) setBlocked(SIG_UNBLOCK);  // better an abrupt end than none
}

Interruption::~Interruption()
{
  if (descriptor_ >= 0) close(descriptor_);
  setBlocked(SIG_UNBLOCK);
}

bool Interruption::requested()
{
  signalfd_siginfo signal{};
  if (!requested_ && descriptor_ >= 0 && read(descriptor_, &signal, sizeof(signal)) == sizeof(signal)) {
    requested_ = true;
    setBlocked(SIG_UNBLOCK);
  }
  return requested_;
}

// A signal that came before is delivered here.
Interruption::Suspension::Suspension(const Interruption& interruption)
    : blocked_(interruption.descriptor_ >= 0 && !interruption.requested_)
{
  if (blocked_) setBlocked(SIG_UNBLOCK);
}

Interruption::Suspension::~Suspension()
{
  if (blocked_) setBlocked(SIG_BLOCK);
}

}  // namespace eyeslam::apps
