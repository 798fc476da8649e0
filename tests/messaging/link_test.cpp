// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <vector>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/retina_pose_t.hpp"

namespace eyeslam::messaging {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSession = 42;

/// Keeps the bytes of every message of a channel.
class Recorder {
 public:
  Recorder(lcm::LCM& lcm, const std::string& channel) : lcm_(lcm) { lcm.subscribe(channel, &Recorder::take, this); }

  std::vector<std::vector<std::uint8_t>> received()
  {
    while (lcm_.handleTimeout(0) > 0) continue;
    return messages_;
  }

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string&)
  {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    messages_.emplace_back(bytes, bytes + buffer->data_size);
  }

  lcm::LCM& lcm_;
  std::vector<std::vector<std::uint8_t>> messages_;
};

template <class Message>
Message decoded(const std::vector<std::uint8_t>& bytes)
{
  Message message;
  EXPECT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return message;
}

std::string refusalOf(const std::string& url, const std::optional<Key>& key = {})
{
  try {
    Link link(url, kSession, key);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(Publisher, FillsSenderTimeSessionAndConsecutiveNumbers)
{
  Link link("memq://", kSession, {});
  Recorder recorder(link.lcm(), "RETINA_POSE");
  Publisher<retina_pose_t> publisher(link, "RETINA_POSE");
  retina_pose_t message{};
  message.x_px = 1.5;
  ASSERT_TRUE(publisher.publish(message, 1000));
  ASSERT_TRUE(publisher.publish(message, 2000));

  const auto received = recorder.received();
  ASSERT_EQ(received.size(), 2U);
  for (std::int64_t i = 0; i < 2; ++i) {
    const auto pose = decoded<retina_pose_t>(received[static_cast<std::size_t>(i)]);
    EXPECT_EQ(pose.seq, i);
    EXPECT_EQ(pose.session, kSession);
    EXPECT_EQ(pose.utime_sent, 1000 * (i + 1));
    EXPECT_EQ(pose.x_px, 1.5);
  }
}

TEST(Publisher, SignsWithTheLinksKeySoThatOnlyThisChannelVerifies)
{
  const Key key = {1, 2, 3};
  Link link("memq://", kSession, key);
  Recorder recorder(link.lcm(), "RETINA_POSE");
  Publisher<retina_pose_t> publisher(link, "RETINA_POSE");
  retina_pose_t message{};
  ASSERT_TRUE(publisher.publish(message, 1000));

  const auto received = recorder.received();
  ASSERT_EQ(received.size(), 1U);
  const Authenticator authenticator(key);
  EXPECT_TRUE(authenticator.verifies("RETINA_POSE", received[0].data(), received[0].size()));
  EXPECT_FALSE(authenticator.verifies("TOOL_TIP", received[0].data(), received[0].size()));
}

TEST(Publisher, LeavesTheTagZeroWithoutAKey)
{
  Link link("memq://", kSession, {});
  Recorder recorder(link.lcm(), "RETINA_POSE");
  Publisher<retina_pose_t> publisher(link, "RETINA_POSE");
  retina_pose_t message{};
  for (auto& byte : message.tag) byte = 7;
  ASSERT_TRUE(publisher.publish(message, 1000));
  const auto pose = decoded<retina_pose_t>(recorder.received().at(0));
  EXPECT_THAT(pose.tag, ::testing::Each(0));
}

TEST(Publisher, SendsTextOfAnyLength)
{
  Link link("memq://", kSession, {});
  Recorder recorder(link.lcm(), "MARK");
  Publisher<mark_t> publisher(link, "MARK");
  mark_t mark{};
  mark.kind = mark_t::NOTE;
  for (const std::size_t length : {0U, 5000U, 3U}) {
    mark.note.assign(length, 'x');
    ASSERT_TRUE(publisher.publish(mark, 1000));
  }
  const auto received = recorder.received();
  EXPECT_EQ(decoded<mark_t>(received.at(1)).note.size(), 5000U);
  EXPECT_EQ(decoded<mark_t>(received.at(2)).note, "xxx");
}

TEST(Link, RefusesAnUnusableUrlByName)
{
  EXPECT_THAT(refusalOf("nonsense"), HasSubstr("'nonsense': expected udpm://"));
  EXPECT_THAT(refusalOf("nonsense://x", Key{}), HasSubstr("'nonsense://x' cannot be used"));
  EXPECT_THAT(refusalOf("udpm://239.255.76.67?ttl=0"), HasSubstr("has no port"));
  EXPECT_THAT(refusalOf("udpm://10.0.0.1:7667?ttl=0"), HasSubstr("multicast route"));
  EXPECT_THAT(refusalOf("tcpq://127.0.0.1:1", Key{}), HasSubstr("cannot be used"));
}

TEST(Link, LeavesThisComputerOnlyWithAKey)
{
  EXPECT_THAT(refusalOf("udpm://239.255.76.67:7667?ttl=1"), HasSubstr("no key"));
  EXPECT_THAT(refusalOf("udpm://239.255.76.67:7667?ttl=0&ttl=1"), HasSubstr("no key"));
  EXPECT_THAT(refusalOf("tcpq://127.0.0.1:7700"), HasSubstr("no key"));
  EXPECT_EQ(refusalOf("memq://"), "");
}

TEST(Link, TakesAnEmptyUrlFromTheEnvironment)
{
  ::setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(Link("", kSession, {}).url(), "memq://");
  ::unsetenv("LCM_DEFAULT_URL");
}

}  // namespace
}  // namespace eyeslam::messaging
