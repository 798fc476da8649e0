// SPDX-License-Identifier: GPL-3.0-or-later
// Two processes over UDP multicast. Each test has a port of its own; TTL 0 keeps all of it in this computer.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <string>

#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"

namespace eyeslam::messaging {
namespace {

constexpr std::int64_t kMillisecond = 1000;
const Key kKey = {7, 7};

std::int64_t clockOf(clockid_t id)
{
  timespec now{};
  clock_gettime(id, &now);
  return now.tv_sec * std::int64_t{1'000'000} + now.tv_nsec / 1000;
}
ReceiveTime now() { return {clockOf(CLOCK_MONOTONIC), clockOf(CLOCK_REALTIME)}; }

std::string freeUrl()
{
  static int offset = 0;
  return "udpm://239.255.76.67:" + std::to_string(20'000 + (::getpid() * 7 + offset++) % 40'000) + "?ttl=0";
}

bool canMulticast()
{
  try {
    Link link(freeUrl(), 1, {});
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Bytes that the system grants, with its own overhead.
int receiveBuffer()
{
  const int probe = ::socket(AF_INET, SOCK_DGRAM, 0);
  int bytes = 8'000'000;
  socklen_t size = sizeof(bytes);
  ::setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &bytes, size);
  ::getsockopt(probe, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  ::close(probe);
  return bytes;
}

/// A process that runs until it ends or its object does. Forked before this process has a link (LCM does not survive
/// it).
class Process {
 public:
  explicit Process(const std::function<void()>& work) : id_(::fork())
  {
    if (id_ != 0) return;
    work();
    ::_exit(0);
  }
  ~Process()
  {
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }

 private:
  pid_t id_;
};

void sendStates(const std::string& url, std::int64_t session, int count)
{
  ::usleep(300 * kMillisecond);  // for the receiver to come up
  Link link(url, session, kKey);
  Publisher<micron_state_t> states(link);
  MicronState state;
  const std::int64_t start = clockOf(CLOCK_MONOTONIC);
  for (int i = 0; i < count; ++i) {
    while (clockOf(CLOCK_MONOTONIC) < start + i * kMillisecond) ::usleep(200);
    state.tip.position.x() = 1e-6 * i;
    const std::int64_t utime = clockOf(CLOCK_REALTIME);
    states.publish(state, utime, utime);
  }
}

class Multicast : public ::testing::Test {
 protected:
  void SetUp() override
  {
    if (!canMulticast()) {
      GTEST_SKIP() << "NO MULTICAST ROUTE: nothing of this file is tested (ip route add 224.0.0.0/4 dev lo)";
    }
  }
  const std::string url_ = freeUrl();
};

// A reader that stalls for 100 ms every 300 ms hears every message of a 1 kHz sender and is never left with an old one.
TEST_F(Multicast, DrainsToTheLatestAfterStallsWithoutLoss)
{
  constexpr int kCount = 2000;
  const Process sender([this] { sendStates(url_, 5, kCount); });
  Link link(url_, 1, kKey);
  Subscription<micron_state_t> states(link);
  std::int64_t stalls = 0, backlog = 0;
  const std::int64_t end = now().monotonic + 20'000 * kMillisecond;
  while (states.header().seq < kCount - 1 && now().monotonic < end) {
    const bool stalled = ++stalls % 3 == 0;
    ::usleep(stalled ? 100 * kMillisecond : 10 * kMillisecond);
    const std::int64_t before = states.accepted();
    link.drain(now());
    if (stalled) backlog = std::max(backlog, states.accepted() - before);
  }
  EXPECT_EQ(states.accepted(), kCount);
  EXPECT_EQ(states.lost(), 0);
  EXPECT_GT(backlog, 50);  // more than LCM's queue of 30 holds
  EXPECT_EQ(states.fault(), retina::Reason::none);
  EXPECT_EQ(link.drain(now()), 0U);
}

// 1,000 messages of half a kilobyte at once: the system's default buffer loses one in six of 200.
TEST_F(Multicast, LosesNothingOfABurst)
{
  Link link(url_, 1, kKey);
  if (receiveBuffer() < 4'000'000) GTEST_SKIP() << "THE SYSTEM GRANTS NO LARGE RECEIVE BUFFER (net.core.rmem_max)";
  Subscription<micron_state_t> states(link);
  Publisher<micron_state_t> publisher(link);
  const std::int64_t utime = clockOf(CLOCK_REALTIME);
  for (int i = 0; i < 1000; ++i) publisher.publish(MicronState(), utime, utime);
  for (int i = 0; i < 200 && states.received() < 1000; ++i) {
    ::usleep(10 * kMillisecond);
    link.drain(now());
  }
  EXPECT_EQ(states.accepted(), 1000);
  EXPECT_EQ(states.lost(), 0);
}

TEST_F(Multicast, WaitsForTheNextMessage)
{
  const Process sender([this] { sendStates(url_, 5, 3); });
  Link link(url_, 1, kKey);
  Subscription<micron_state_t> states(link);
  EXPECT_FALSE(link.wait(20));
  for (int i = 0; i < 100 && states.accepted() < 3; ++i) {
    if (link.wait(100)) link.drain(now());
  }
  EXPECT_EQ(states.accepted(), 3);
}

TEST_F(Multicast, HearsOneOfTwoSendersAndCountsTheOther)
{
  const Process first([this] { sendStates(url_, 5, 300); });
  const Process second([this] { sendStates(url_, 6, 300); });
  Link link(url_, 1, kKey);
  Subscription<micron_state_t> states(link);
  for (int i = 0; i < 300 && states.received() < 600; ++i) {
    ::usleep(20 * kMillisecond);
    link.drain(now());
  }
  EXPECT_EQ(states.accepted(), 300);
  EXPECT_EQ(states.refused(retina::Reason::wrong_session), 300);
}

// A listener that joins in the middle has the whole map after one cycle.
TEST_F(Multicast, CarriesTheMapToALateListener)
{
  retina::VesselMap map;
  map.width = 300;
  map.height = 200;
  map.version = 3;
  map.probability.assign(60'000, 200);
  map.calibre_px = map.seen = map.probability;
  const Process sender([&] {
    Link link(url_, 5, kKey);
    Publisher<vessel_map_t> tiles(link);
    MapTileCycle cycle;
    vessel_map_t tile{};
    for (int i = 0; i < 20'000; ++i) {
      cycle.next(map, 9, clockOf(CLOCK_REALTIME), tile);
      tiles.publish(tile, clockOf(CLOCK_REALTIME));
      if (i % 8 == 7) ::usleep(5 * kMillisecond);
    }
  });
  ::usleep(150 * kMillisecond);
  Link link(url_, 1, kKey);
  MapAssembler maps;
  Subscription<vessel_map_t> tiles(link, [&](const vessel_map_t& tile, const MessageHeader&) { maps.add(tile); });
  for (int i = 0; i < 1000 && !maps.isComplete(); ++i) {
    ::usleep(10 * kMillisecond);
    link.drain(now());
  }
  EXPECT_TRUE(maps.isComplete());
  EXPECT_EQ(maps.map().probability, map.probability);
}

}  // namespace
}  // namespace eyeslam::messaging
