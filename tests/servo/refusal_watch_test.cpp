// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/refusal_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace eyeslam;
using messaging::refusalIndex;
using messaging::Refusals;
using retina::Reason;
using servo::RefusalWatch;

namespace {

constexpr std::int64_t kSecond = 1'000'000;

// Counted by hand over every window that ends now.
TEST(RefusalWatch, SaysTooManyExactlyWhenAWindowHoldsMore)
{
  std::mt19937 random(1);
  for (int run = 0; run < 50; ++run) {
    RefusalWatch watch;
    Refusals counts{};
    std::vector<std::int64_t> times;
    watch.update(counts, 0);
    const double rate = std::uniform_real_distribution<double>(1.0, 8.0)(random);  // a second
    for (std::int64_t now = 1000; now < 10 * kSecond; now += 1000) {
      if (std::bernoulli_distribution(1e-3 * rate)(random)) {
        ++counts[refusalIndex(Reason::replayed)];
        times.push_back(now);
      }
      watch.update(counts, now);
      const auto within =
          std::count_if(times.begin(), times.end(), [now](std::int64_t t) { return now - t < kSecond; });
      ASSERT_EQ(watch.tooMany(now, kSecond, 3), within > 3 ? Reason::replayed : Reason::none) << now;
    }
  }
}

TEST(RefusalWatch, LateAndOvertakenMessagesAreNoAttack)
{
  RefusalWatch watch;
  Refusals counts{};
  watch.update(counts, 0);
  counts[refusalIndex(Reason::expired)] = counts[refusalIndex(Reason::out_of_order)] = 1000;
  watch.update(counts, 1000);
  EXPECT_EQ(watch.tooMany(1000, kSecond, 3), Reason::none);
}

TEST(RefusalWatch, ThePastOfASourceIsNotCountedNorIsItsRestart)
{
  RefusalWatch watch;
  Refusals counts{};
  counts[refusalIndex(Reason::wrong_type)] = 100;
  watch.update(counts, 1000);
  EXPECT_EQ(watch.tooMany(1000, kSecond, 3), Reason::none);
  counts[refusalIndex(Reason::wrong_type)] = 0;
  watch.update(counts, 2000);
  counts[refusalIndex(Reason::wrong_type)] = 3;
  watch.update(counts, 3000);
  EXPECT_EQ(watch.tooMany(3000, kSecond, 3), Reason::none);
  counts[refusalIndex(Reason::wrong_type)] = 4;
  watch.update(counts, 4000);
  EXPECT_EQ(watch.tooMany(4000, kSecond, 3), Reason::wrong_type);
}

TEST(RefusalWatch, ForgettingStartsAnew)
{
  RefusalWatch watch;
  Refusals counts{};
  watch.update(counts, 0);
  counts[refusalIndex(Reason::unauthenticated)] = 1'000'000;
  watch.update(counts, 1000);
  EXPECT_EQ(watch.tooMany(1000, kSecond, 15), Reason::unauthenticated);
  watch.forget();
  EXPECT_EQ(watch.tooMany(1000, kSecond, 0), Reason::none);
}

}  // namespace
