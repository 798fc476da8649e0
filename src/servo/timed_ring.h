// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

/// The newest `Count` values with their times, strictly rising. `Value` adds and scales. Never allocates.
template <class Value, std::size_t Count>
class TimedRing {
 public:
  /// `utime` must be later than the newest's.
  void push(std::int64_t utime, const Value& value)
  {
    entries_[next_] = {utime, value};
    next_ = (next_ + 1) % Count;
    if (size_ < Count) ++size_;
  }
  void clear() { size_ = 0; }
  /// Replaces each value by change(value).
  template <class Change>
  void transform(const Change& change)
  {
    for (std::size_t age = 0; age < size_; ++age) {
      Entry& entry = entries_[(next_ + Count - 1 - age) % Count];
      entry.value = change(entry.value);
    }
  }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  /// 0 is the newest.
  const Value& value(std::size_t age) const { return entry(age).value; }
  std::int64_t utime(std::size_t age) const { return entry(age).utime; }
  bool covers(std::int64_t utime_us) const { return size_ > 0 && utime_us >= utime(size_ - 1) && utime_us <= utime(0); }

  /// Linear between two values; at or beyond an end the end's. Not for an empty ring.
  Value at(std::int64_t utime_us) const
  {
    if (utime_us >= utime(0)) return value(0);
    if (utime_us <= utime(size_ - 1)) return value(size_ - 1);
    const std::size_t age = firstAtOrBefore(utime_us);
    const double whole = seconds(utime(age - 1) - utime(age));
    const double part = seconds(utime_us - utime(age)) / whole;
    return value(age) * (1.0 - part) + value(age - 1) * part;
  }

  /// The age of the newest value that is not later than `utime_us`; size() when there is none.
  std::size_t firstAtOrBefore(std::int64_t utime_us) const
  {
    std::size_t low = 0;
    std::size_t high = size_;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (utime(middle) <= utime_us) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low;
  }

 private:
  struct Entry {
    std::int64_t utime = 0;
    Value value{};
  };

  const Entry& entry(std::size_t age) const { return entries_[(next_ + Count - 1 - age) % Count]; }

  std::array<Entry, Count> entries_{};
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace eyeslam::servo
