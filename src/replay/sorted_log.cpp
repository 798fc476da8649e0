// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/sorted_log.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace eyeslam::replay {
namespace {

constexpr std::size_t kSpareBytes = 2048;  // a message of a trial; larger buffers are not kept

// Times of a log are not negative, so the difference fits.
std::int64_t distance(std::int64_t a, std::int64_t b) { return a > b ? a - b : b - a; }

std::int64_t middleOf(std::vector<std::int64_t> utimes)
{
  const auto middle = utimes.begin() + static_cast<std::ptrdiff_t>(utimes.size() / 2);
  std::nth_element(utimes.begin(), middle, utimes.end());
  return *middle;
}

}  // namespace

SortedLog::SortedLog(const std::string& path, SortWindow window) : reader_(path), window_(window)
{
  if (window.span_us <= 0 || window.events == 0) throw std::invalid_argument("a window of nothing sorts nothing");
}

bool SortedLog::isAfter(const Holder& a, const Holder& b)
{
  return std::tie(a->sorted.part, a->sorted.utime, a->order) > std::tie(b->sorted.part, b->sorted.utime, b->order);
}

std::optional<SortedEvent> SortedLog::next()
{
  recycle();
  if (!begun_) findTheStart();
  while (!mayRelease() && read()) continue;
  if (heap_.empty()) return std::nullopt;
  release();
  return current_->sorted;
}

// The first time alone may be wrong: the first of three that agrees with their middle is where the log begins.
void SortedLog::findTheStart()
{
  begun_ = true;
  std::vector<Holder> first;
  std::vector<std::int64_t> utimes;
  while (first.size() < 3) {
    const std::optional<files::LogEvent> event = reader_.next();
    if (!event) break;
    first.push_back(holderOf(*event));
    utimes.push_back(event->utime);
  }
  if (first.empty()) return;
  const auto agrees = [middle = middleOf(utimes)](std::int64_t utime) { return distance(utime, middle) <= kJump_us; };
  settled_.fill(*std::find_if(utimes.begin(), utimes.end(), agrees));
  for (Holder& held : first) place(std::move(held));
}

bool SortedLog::read()
{
  if (ended_) return false;
  if (const std::optional<files::LogEvent> event = reader_.next()) {
    place(holderOf(*event));
  } else {
    ended_ = true;
    while (!doubted_.empty()) judgeFirstDoubted();
  }
  return true;
}

SortedLog::Holder SortedLog::holderOf(const files::LogEvent& event)
{
  Holder held = spare_.empty() ? std::make_unique<Held>() : std::move(spare_.back());
  if (!spare_.empty()) spare_.pop_back();
  held->bytes.assign(event.channel.begin(), event.channel.end());
  held->bytes.insert(held->bytes.end(), event.data, event.data + event.size);
  held->sorted = {event, event.utime};
  held->sorted.event.channel = {reinterpret_cast<const char*>(held->bytes.data()), event.channel.size()};
  held->sorted.event.data = held->bytes.data() + event.channel.size();
  held->order = order_++;
  return held;
}

// Of the last two times the earlier one counts: one alone that is ahead puts no other in doubt.
bool SortedLog::isDoubtful(std::int64_t utime) const
{
  return distance(utime, settled_[0]) > kJump_us || utime < std::min(settled_[0], settled_[1]) - window_.span_us;
}

void SortedLog::place(Holder held)
{
  const std::int64_t utime = held->sorted.event.utime;
  if (isDoubtful(utime)) {
    doubted_.push_back(std::move(held));
    if (doubted_.size() > kMostDoubted) judgeFirstDoubted();
    return;
  }
  for (Holder& doubted : std::exchange(doubted_, {})) passDoubted(std::move(doubted));
  settle(utime);
  hold(std::move(held), utime);
}

// The log has not come back to where it was: the next one tells whether it goes on from here.
void SortedLog::judgeFirstDoubted()
{
  std::vector<Holder> doubted = std::exchange(doubted_, {});
  const std::int64_t utime = doubted.front()->sorted.event.utime, before = settled_[0];
  const std::int64_t next_utime = doubted.size() > 1 ? doubted[1]->sorted.event.utime : before;
  if (distance(next_utime, utime) < distance(next_utime, before)) {
    if (utime < before) {
      ++part_;
      ++findings_.steps_back;
    }
    settled_.fill(utime);
    hold(std::move(doubted.front()), utime);
  } else {
    passDoubted(std::move(doubted.front()));
  }
  for (std::size_t i = 1; i < doubted.size(); ++i) place(std::move(doubted[i]));
}

// Where it stood in the file, if its time cannot be true.
void SortedLog::passDoubted(Holder held)
{
  const std::int64_t utime = held->sorted.event.utime, before = settled_[0];
  held->sorted.stray = distance(utime, before) > kJump_us;
  findings_.strays += held->sorted.stray ? 1 : 0;
  const std::int64_t place = held->sorted.stray ? before : utime;
  hold(std::move(held), place);
}

void SortedLog::settle(std::int64_t utime)
{
  settled_[1] = settled_[0];
  settled_[0] = utime;
}

void SortedLog::hold(Holder held, std::int64_t utime)
{
  held->sorted.utime = utime;
  held->sorted.part = part_;
  held_bytes_ += held->bytes.size();
  heap_.push_back(std::move(held));
  std::push_heap(heap_.begin(), heap_.end(), isAfter);
}

// The earlier of the last two times counts: one alone that is wrong must not empty the window.
bool SortedLog::mayRelease() const
{
  if (heap_.empty()) return false;
  if (ended_ || heap_.size() >= window_.events || held_bytes_ >= window_.bytes) return true;
  const Held& top = *heap_.front();
  return top.sorted.part < part_ || std::min(settled_[0], settled_[1]) - top.sorted.utime >= window_.span_us;
}

void SortedLog::release()
{
  std::pop_heap(heap_.begin(), heap_.end(), isAfter);
  current_ = std::move(heap_.back());
  heap_.pop_back();
  held_bytes_ -= current_->bytes.size();
  SortedEvent& sorted = current_->sorted;
  if (!start_) start_ = sorted.utime;
  sorted.since_us = sorted.utime - *start_;
  if (sorted.part != delivered_part_) delivered_ = 0;
  delivered_part_ = sorted.part;
  sorted.late = sorted.utime < delivered_;
  if (sorted.late) {
    ++findings_.late;
    findings_.latest_us = std::max(findings_.latest_us, delivered_ - sorted.utime);
  }
  delivered_ = std::max(delivered_, sorted.utime);
}

void SortedLog::recycle()
{
  if (current_ && current_->bytes.capacity() <= kSpareBytes) spare_.push_back(std::move(current_));
  current_.reset();
}

}  // namespace eyeslam::replay
