// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>
#include <utility>

namespace eyeslam::apps {

/// One place between a patient thread and a loop that must never wait: what either side leaves there, the other takes
/// by a swap, so that nothing is copied, and what the loop gives back is freed by the patient one.
///
///   patient:  place.offer(newest);                        // blocks for a swap at most
///   loop:     if (place.tryTake(mine)) mine = use(mine);  // mine goes back with the next tryTake
///
/// Only the newest value counts: an offer replaces one that nobody took. The loop's calls neither block nor allocate;
/// they fail, to be tried again in the next cycle, while the other side is at it.
template <class T>
class Exchange {
 public:
  Exchange() = default;
  /// @param spare  lies in the place without being new: a buffer that the first offer brings back
  explicit Exchange(T spare) : place_(std::move(spare)) {}

  /// Patient side. What was in the place, taken or not, ends here.
  void offer(T value)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(place_, value);
    fresh_ = true;
  }  // the old value outlives the lock, for it is a parameter

  /// Patient side. @return whether there was something new, now in `mine`
  bool take(T& mine)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return swapFresh(mine);
  }

  /// Loop's side. @return whether there was something new, now in `mine`; what `mine` was has gone to the other side
  bool tryTake(T& mine) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    return lock.owns_lock() && swapFresh(mine);
  }

  /// Loop's side. @return whether `mine` was left in the place, and is now what was there before
  bool tryOffer(T& mine) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return false;
    std::swap(place_, mine);
    fresh_ = true;
    return true;
  }

 private:
  bool swapFresh(T& mine) noexcept
  {
    if (!fresh_) return false;
    std::swap(place_, mine);
    fresh_ = false;
    return true;
  }

  std::mutex mutex_;
  T place_{};
  bool fresh_ = false;  // offered and not yet taken
};

}  // namespace eyeslam::apps
