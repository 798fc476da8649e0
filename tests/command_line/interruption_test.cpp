// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/interruption.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <optional>

namespace eyeslam::apps {
namespace {

TEST(Interruption, MakesASignalAQuestion)
{
  Interruption interruption;
  EXPECT_FALSE(interruption.requested());
  std::raise(SIGINT);
  EXPECT_TRUE(interruption.requested());
  EXPECT_TRUE(interruption.requested()) << "it stays so";
}

TEST(InterruptionDeathTest, EndsTheProgramAtOnceWhileSuspended)
{
  for (const int number : {SIGINT, SIGTERM}) {
    EXPECT_EXIT(
        {
          Interruption interruption;
          const Interruption::Suspension suspension(interruption);
          std::raise(number);
          std::exit(0);
        },
        testing::KilledBySignal(number), "");
  }
}

TEST(InterruptionDeathTest, EndsItWhenTheSignalCameBeforeTheSuspension)
{
  EXPECT_EXIT(
      {
        Interruption interruption;
        std::raise(SIGINT);
        const Interruption::Suspension suspension(interruption);
        std::exit(0);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(Interruption, IsAQuestionAgainAfterASuspension)
{
  Interruption interruption;
  std::optional<Interruption::Suspension> suspension(std::in_place, interruption);
  suspension.reset();
  std::raise(SIGINT);
  EXPECT_TRUE(interruption.requested());
}

}  // namespace
}  // namespace eyeslam::apps
