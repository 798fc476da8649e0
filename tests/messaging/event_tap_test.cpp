// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/event_tap.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/messaging/truth_messages.h"

namespace eyeslam::messaging {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;

mark_t note(const std::string& text)
{
  mark_t mark{};
  mark.kind = mark_t::NOTE;
  mark.note = text;
  return mark;
}

void sendNote(Publisher<mark_t>& marks, const std::string& text, std::int64_t utime = kStart)
{
  mark_t mark = note(text);
  marks.publish(mark, utime);
}

truth_t truthAt(double x)
{
  truth_t truth{};
  truth.um_per_px = 5.0;
  truth.tip[0] = x;
  return truth;
}

/// What came by: number, time, channel, and the text or the place in it.
struct Heard {
  std::int64_t number, utime;
  std::string channel, text;
  bool operator==(const Heard& other) const
  {
    return number == other.number && utime == other.utime && channel == other.channel && text == other.text;
  }
};

Heard read(const TappedEvent& event)
{
  Heard heard{event.number, event.utime, std::string(event.channel), ""};
  mark_t mark{};
  truth_t truth{};
  if (event.channel == "MARK" && decode(event.data, event.size, mark)) heard.text = mark.note;
  if (event.channel == "TRUTH" && decode(event.data, event.size, truth)) heard.text = std::to_string(truth.tip[0]);
  return heard;
}

// Also of one who answers while the link is drained.
TEST(EventTap, HearsAllChannelsInTheOrderOfSendingWithTheTimeThatItWasTold)
{
  Link link("memq://", 9, std::nullopt);
  std::vector<Heard> all;
  EventTap tap(link, [&all](const TappedEvent& event) { all.push_back(read(event)); });
  Publisher<mark_t> marks(link);
  Publisher<truth_t> truths(link);
  const Subscription<truth_t> answers(link, [&](const truth_t& truth, const MessageHeader&) {
    if (truth.tip[0] == 1.0) sendNote(marks, "answer");
  });
  tap.setTime(kStart);
  sendNote(marks, "first");
  for (truth_t truth : {truthAt(1.0), truthAt(2.0)}) truths.publish(truth, kStart);
  link.drain({kStart, kStart});
  tap.setTime(kStart + 1000);
  sendNote(marks, "last", kStart + 1000);
  link.drain({kStart + 1000, kStart + 1000});
  const std::vector<Heard> expected{{0, kStart, "MARK", "first"},
                                    {1, kStart, "TRUTH", "1.000000"},
                                    {2, kStart, "TRUTH", "2.000000"},
                                    {3, kStart, "MARK", "answer"},
                                    {4, kStart + 1000, "MARK", "last"}};
  EXPECT_TRUE(all == expected);
}

TEST(EventTap, ThrowsWhatItsListenerThrewOnceAtTheNextTime)
{
  Link link("memq://", 9, std::nullopt);
  int heard = 0;
  EventTap tap(link, [&heard](const TappedEvent&) {
    if (++heard <= 2) throw std::runtime_error("disk full " + std::to_string(heard));
  });
  Publisher<mark_t> marks(link);
  for (int i = 0; i < 3; ++i) sendNote(marks, "x");
  EXPECT_NO_THROW(link.drain({kStart, kStart}));
  EXPECT_EQ(heard, 3);
  try {
    tap.setTime(kStart + 1000);
    ADD_FAILURE() << "what was thrown is lost";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "disk full 1") << "the first cause is the one to know";
  }
  EXPECT_NO_THROW(tap.setTime(kStart + 2000));
}

TEST(EventTap, HearsNothingMoreWhenItIsGone)
{
  Link link("memq://", 9, std::nullopt);
  int heard = 0;
  Publisher<mark_t> marks(link);
  {
    EventTap tap(link, [&heard](const TappedEvent&) { ++heard; });
    sendNote(marks, "x");
    link.drain({kStart, kStart});
  }
  sendNote(marks, "x");
  link.drain({kStart, kStart});
  EXPECT_EQ(heard, 1);
}

}  // namespace
}  // namespace eyeslam::messaging
