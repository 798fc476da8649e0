// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/event_tap.h"

#include <lcm/lcm-cpp.hpp>
#include <utility>

namespace eyeslam::messaging {

namespace {

constexpr int kTapCapacity = 10'000;  // far more than a link has between two drains of lock step

}  // namespace

EventTap::EventTap(Link& link, Each each)
    : link_(link), each_(std::move(each)), subscription_(link.lcm().subscribe(".*", &EventTap::onMessage, this))
{
  subscription_->setQueueCapacity(kTapCapacity);
}

EventTap::~EventTap() { link_.lcm().unsubscribe(subscription_); }

void EventTap::setTime(std::int64_t utime)
{
  utime_ = utime;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void EventTap::onMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel)
{
  try {
    each_({events_++, utime_, channel, static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
}

}  // namespace eyeslam::messaging
