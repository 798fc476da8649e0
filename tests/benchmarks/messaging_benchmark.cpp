// SPDX-License-Identifier: GPL-3.0-or-later
// What a message costs: its tag, sending, receiving. memq without a network; CPU time.
#include <benchmark/benchmark.h>

#include <vector>

#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/subscription.h"

using namespace eyeslam;
using namespace eyeslam::messaging;

namespace {

const Key kKey = {1, 2, 3};

void MakeATag(benchmark::State& state)
{
  const Authenticator authenticator(kKey);
  const std::vector<std::uint8_t> body(static_cast<std::size_t>(state.range(0)), 7);
  for (auto _ : state) benchmark::DoNotOptimize(authenticator.tag("MICRON_COMMAND", body.data(), body.size()));
}
BENCHMARK(MakeATag)->Arg(160)->Arg(500)->Arg(1350);

template <class Message>
void publish(benchmark::State& state)
{
  Link link("memq://", 1, kKey);
  Publisher<Message> publisher(link);
  const typename Conversion<Message>::Value value;
  std::int64_t utime = 1'000'000;
  for (auto _ : state) {
    publisher.publish(value, utime, utime);
    ++utime;
    if (utime % 1000 == 0) {
      state.PauseTiming();
      link.drain({utime, utime});
      state.ResumeTiming();
    }
  }
}
BENCHMARK(publish<micron_command_t>);
BENCHMARK(publish<micron_state_t>);

/// Decoding, tag, checks, conversion, and what LCM does around them.
template <class Message>
void receive(benchmark::State& state)
{
  constexpr int kMessages = 1000;
  Link link("memq://", 1, kKey);
  Subscription<Message> subscription(link);
  Publisher<Message> publisher(link);
  const typename Conversion<Message>::Value value;
  std::int64_t utime = 1'000'000;
  for (auto _ : state) {
    state.PauseTiming();
    for (int i = 0; i < kMessages; ++i, ++utime) publisher.publish(value, utime, utime);
    state.ResumeTiming();
    link.drain({utime, utime});
  }
  state.SetItemsProcessed(state.iterations() * kMessages);
  if (subscription.accepted() != subscription.received()) state.SkipWithError("messages were refused");
}
BENCHMARK(receive<micron_command_t>);
BENCHMARK(receive<micron_state_t>);

}  // namespace

BENCHMARK_MAIN();
