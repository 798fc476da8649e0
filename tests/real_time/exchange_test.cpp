// SPDX-License-Identifier: GPL-3.0-or-later
#include "real_time/exchange.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace eyeslam::apps {
namespace {

TEST(Exchange, GivesTheNewestOfferOnce)
{
  Exchange<int> place;
  int mine = 7;
  EXPECT_FALSE(place.tryTake(mine));
  place.offer(1);
  place.offer(2);
  EXPECT_TRUE(place.tryTake(mine));
  EXPECT_EQ(mine, 2);
  EXPECT_FALSE(place.tryTake(mine)) << "what went back is not new";
  EXPECT_EQ(mine, 2);
}

TEST(Exchange, CarriesBothWays)
{
  Exchange<int> place;
  int from_loop = 3, mine = 0;
  EXPECT_TRUE(place.tryOffer(from_loop));
  EXPECT_TRUE(place.take(mine));
  EXPECT_EQ(mine, 3);
  EXPECT_FALSE(place.take(mine));
}

/// Notes in which thread it ends.
struct Witness {
  explicit Witness(std::atomic<int>& wrong) : wrong_(wrong) {}
  ~Witness()
  {
    if (std::this_thread::get_id() != owner_) ++wrong_;
  }
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

 private:
  std::atomic<int>& wrong_;
  std::thread::id owner_ = std::this_thread::get_id();
};

TEST(Exchange, LetsTheLoopFreeNothing)
{
  std::atomic<int> freed_by_the_loop{0};
  std::atomic<bool> over{false};
  std::atomic<int> taken{0};
  Exchange<std::shared_ptr<Witness>> place;
  std::shared_ptr<Witness> in_use;  // the loop's, freed below by this thread
  std::shared_ptr<Witness> last;
  std::thread loop([&] {
    while (!over) {
      if (!place.tryTake(last)) continue;
      std::swap(in_use, last);  // as Servo::adopt does: the old one comes back
      ++taken;
    }
  });
  for (int i = 0; i < 5000 || taken < 100; ++i) place.offer(std::make_shared<Witness>(freed_by_the_loop));
  over = true;
  loop.join();
  EXPECT_EQ(freed_by_the_loop, 0);
}

TEST(Exchange, NeverMixesTwoValuesUp)
{
  struct Pair {
    std::int64_t a = 0;
    std::int64_t b = 0;
  };
  Exchange<Pair> place;
  std::atomic<bool> over{false};
  std::thread loop([&] {
    for (std::int64_t i = 1; !over; ++i) {
      Pair mine{i, -i};
      place.tryOffer(mine);
      std::this_thread::sleep_for(std::chrono::microseconds(20));  // or it would hardly ever let go
    }
  });
  std::int64_t newest = 0;
  for (int i = 0; i < 500;) {
    Pair mine;
    if (!place.take(mine)) continue;
    ++i;
    EXPECT_EQ(mine.a, -mine.b);
    EXPECT_GT(mine.a, newest);
    newest = mine.a;
  }
  over = true;
  loop.join();
}

}  // namespace
}  // namespace eyeslam::apps
