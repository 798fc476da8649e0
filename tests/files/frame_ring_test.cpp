// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/frame_ring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "eyeslam/files/frame_ring_source.h"
#include "support/sanitized.h"

namespace eyeslam::files {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kStart = 1'700'000'000'000'000;  // us since 1970

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

VideoSourceOptions patient(double patience)
{
  VideoSourceOptions options;
  options.now = now;
  options.patience = patience;
  return options;
}

/// A name that no other test has.
std::string newName()
{
  static std::atomic<int> count{0};
  return "eyeslam_test_" + std::to_string(getpid()) + "_" + std::to_string(count++);
}

// 23 px wide: rows end within a word.
FrameRingShape shapeOf(int slots = 4, int type = CV_8UC3) { return {{23, 17}, type, 30.0, slots}; }

/// Every byte tells the frame.
cv::Mat pictureOf(std::int64_t number, const FrameRingShape& shape)
{
  return cv::Mat(shape.size, shape.type, cv::Scalar::all(static_cast<double>(number % 251)));
}

FrameStampInRing stampOf(std::int64_t number) { return {number, kStart + 1000 * number, 500}; }

template <class Action>
std::string refusalOf(const Action& action)
{
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

std::string refusalBySource(const std::string& name)
{
  return refusalOf([&] { FrameRingSource("shm:" + name, patient(0.0)); });
}

TEST(FrameRing, GivesBackEveryBitOfEveryTypeAndOfPartsOfLargerPictures)
{
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    const std::string name = newName();
    FrameRingWriter writer(name, shapeOf(4, type));
    FrameRingSource source("shm:" + name, patient(1.0));
    cv::Mat whole(40, 50, type);
    cv::randu(whole, 0, 65536);
    const cv::Mat part = whole(cv::Rect({5, 7}, shapeOf().size));
    ASSERT_TRUE(writer.write(part, stampOf(3)));
    VideoFrame frame;
    ASSERT_TRUE(source.read(frame));
    EXPECT_EQ(cv::norm(frame.image, part, cv::NORM_INF), 0.0) << type;
    EXPECT_EQ(frame.number, 3);
    EXPECT_EQ(frame.utime, kStart + 3000);
    EXPECT_DOUBLE_EQ(frame.exposure, 0.0005);
  }
}

TEST(FrameRing, GivesTheNewestFrameAndCountsThoseLeftOut)
{
  const std::string name = newName();
  FrameRingWriter writer(name, shapeOf());
  FrameRingSource source("shm:" + name, patient(1.0));
  for (int number = 0; number < 10; ++number) writer.write(pictureOf(number, shapeOf()), stampOf(number));
  VideoFrame frame;
  ASSERT_TRUE(source.read(frame));
  EXPECT_EQ(frame.number, 9);
  EXPECT_EQ(source.framesLeftOut(), 9);
  writer.write(pictureOf(10, shapeOf()), stampOf(10));
  ASSERT_TRUE(source.read(frame));
  EXPECT_EQ(frame.number, 10);
  EXPECT_EQ(source.framesLeftOut(), 9);
  EXPECT_DOUBLE_EQ(frame.t, 0.001);
}

// The writer laps the reader again and again: two slots, as fast as it can.
TEST(FrameRing, NeverGivesATornFrame)
{
  const std::string name = newName();
  const FrameRingShape shape{{160, 120}, CV_8UC3, 30.0, 2};
  const int frames = support::kSanitized ? 300 : 20000;
  auto writer = std::make_unique<FrameRingWriter>(name, shape);
  FrameRingSource source("shm:" + name, patient(10.0));
  std::thread writing([&] {
    for (int number = 0; number < frames; ++number) {
      writer->write(pictureOf(number, shape), stampOf(number));
      if (number % 16 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    writer.reset();
  });
  VideoFrame frame;
  std::int64_t read = 0, last = -1;
  while (source.read(frame)) {
    ++read;
    EXPECT_GT(frame.number, last);
    last = frame.number;
    EXPECT_EQ(cv::norm(frame.image, pictureOf(frame.number, shape), cv::NORM_INF), 0.0);
    EXPECT_EQ(frame.utime, stampOf(frame.number).utime);
  }
  writing.join();
  EXPECT_EQ(last, frames - 1) << "the last one is read before the end";
  EXPECT_EQ(read + source.framesLeftOut(), frames);
}

TEST(FrameRing, EndsWithAReasonWhenItsWriterEnds)
{
  const std::string name = newName();
  auto writer = std::make_unique<FrameRingWriter>(name, shapeOf());
  FrameRingSource source("shm:" + name, patient(5.0));
  writer->write(pictureOf(7, shapeOf()), stampOf(7));
  writer.reset();
  VideoFrame frame;
  EXPECT_TRUE(source.read(frame)) << "what was written before";
  EXPECT_FALSE(source.read(frame));
  EXPECT_THAT(source.notices().back(), HasSubstr("ended after frame 7"));
  EXPECT_THAT(refusalBySource(name), HasSubstr("no program writes")) << "the name is gone";
}

TEST(FrameRing, EndsWithAReasonWhenItsWriterIsKilled)
{
  const std::string name = newName();
  const pid_t child = fork();
  if (child == 0) {
    FrameRingWriter writer(name, shapeOf());
    writer.write(pictureOf(0, shapeOf()), stampOf(0));
    pause();
    _exit(0);
  }
  FrameRingSource source("shm:" + name, patient(10.0));
  VideoFrame frame;
  EXPECT_TRUE(source.read(frame));
  kill(child, SIGKILL);
  EXPECT_FALSE(source.read(frame));
  EXPECT_THAT(source.notices().back(), HasSubstr("died after frame 0"));
  waitpid(child, nullptr, 0);
  EXPECT_THAT(refusalBySource(name), HasSubstr("no program writes")) << "what it left is no ring to read";

  FrameRingWriter next(name, shapeOf());  // takes its place
  next.write(pictureOf(5, shapeOf()), stampOf(5));
  FrameRingSource again("shm:" + name, patient(1.0));
  EXPECT_TRUE(again.read(frame));
  EXPECT_EQ(frame.number, 5);
}

TEST(FrameRing, EndsWithAReasonWhenItsWriterIsSilent)
{
  const std::string name = newName();
  FrameRingWriter writer(name, shapeOf());
  FrameRingSource source("shm:" + name, patient(0.05));
  VideoFrame frame;
  const double start = now();
  EXPECT_FALSE(source.read(frame));
  EXPECT_GE(now() - start, 0.05);
  EXPECT_THAT(source.notices().back(), HasSubstr("no frame for 0.05 s"));
}

TEST(FrameRing, EndsAtOnceWhenAsked)
{
  const std::string name = newName();
  FrameRingWriter writer(name, shapeOf());
  VideoSourceOptions options = patient(1000.0);
  options.stopped = [] { return true; };
  FrameRingSource source("shm:" + name, options);
  VideoFrame frame;
  EXPECT_FALSE(source.read(frame));
  EXPECT_TRUE(source.notices().empty());
}

TEST(FrameRing, IsWaitedFor)
{
  const std::string name = newName();
  std::unique_ptr<FrameRingWriter> writer;
  std::thread starting([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    writer = std::make_unique<FrameRingWriter>(name, shapeOf());
  });
  EXPECT_NO_THROW(FrameRingSource("shm:" + name, patient(10.0)));
  starting.join();
}

TEST(FrameRing, HasOneWriter)
{
  const std::string name = newName();
  FrameRingWriter writer(name, shapeOf());
  EXPECT_THAT(refusalOf([&] { FrameRingWriter(name, shapeOf()); }), HasSubstr("another program writes it"));
  writer.write(pictureOf(0, shapeOf()), stampOf(0));
  VideoFrame frame;
  EXPECT_TRUE(FrameRingSource("shm:" + name, patient(1.0)).read(frame)) << "the first one is as it was";
}

TEST(FrameRing, TakesNoPictureOfAnotherShapeAndNoImpossibleStamp)
{
  FrameRingWriter writer(newName(), shapeOf());
  const cv::Mat good = pictureOf(0, shapeOf());
  EXPECT_FALSE(writer.write(cv::Mat(17, 24, CV_8UC3, cv::Scalar()), stampOf(0)));
  EXPECT_FALSE(writer.write(cv::Mat(17, 23, CV_8UC1, cv::Scalar()), stampOf(0)));
  EXPECT_FALSE(writer.write(cv::Mat(), stampOf(0)));
  EXPECT_FALSE(writer.write(good, {-1, kStart, 0}));
  EXPECT_FALSE(writer.write(good, {0, 0, 0}));
  EXPECT_FALSE(writer.write(good, {0, kStart, -1}));
  EXPECT_TRUE(writer.write(good, stampOf(0)));
}

TEST(FrameRing, RefusesNamesAndShapesThatCannotBe)
{
  for (const char* name : {"", "a/b", "../x", ".hidden", "a b"}) {
    EXPECT_THAT(refusalOf([&] { FrameRingWriter(name, shapeOf()); }), HasSubstr("a name of letters")) << name;
    EXPECT_THAT(refusalBySource(name), HasSubstr("a name of letters")) << name;
  }
  const std::string name = newName();
  for (const FrameRingShape& shape : {FrameRingShape{{0, 10}, CV_8UC3, 30.0, 4},
                                      {{10, 20000}, CV_8UC3, 30.0, 4},
                                      {{10, 10}, CV_32FC3, 30.0, 4},
                                      {{10, 10}, CV_8UC2, 30.0, 4},
                                      {{10, 10}, CV_8UC3, 0.0, 4},
                                      {{10, 10}, CV_8UC3, 30.0, 1}}) {
    EXPECT_THAT(refusalOf([&] { FrameRingWriter(name, shape); }), HasSubstr("shm:" + name));
  }
}

/// Shared memory of somebody else, or a ring with a damaged head.
class ForeignMemory {
 public:
  explicit ForeignMemory(std::size_t bytes) : memory_(std::move(*SharedMemory::create(name_, bytes))) {}
  ~ForeignMemory() { SharedMemory::remove(name_); }

  const std::string& name() const { return name_; }
  std::byte* data() { return memory_.data(); }

 private:
  std::string name_ = newName();
  SharedMemory memory_;
};

std::vector<std::byte> headOf(const FrameRingShape& shape)
{
  const std::string name = newName();
  FrameRingWriter writer(name, shape);
  std::vector<std::byte> head(sizeof(FrameRingHeader));
  std::memcpy(head.data(), SharedMemory::open(name, SharedMemory::Access::read)->data(), head.size());
  return head;
}

TEST(FrameRing, RefusesMemoryThatIsNoRing)
{
  ForeignMemory small(8);
  std::memset(small.data(), 1, 8);
  EXPECT_THAT(refusalBySource(small.name()), HasSubstr("is no ring of frames"));
  ForeignMemory foreign(10000);
  std::memset(foreign.data(), 1, 10000);
  EXPECT_THAT(refusalBySource(foreign.name()), HasSubstr("is no ring of frames"));
}

TEST(FrameRing, LeavesMemoryOfOthersAlone)
{
  const std::string name = newName();
  std::memset(SharedMemory::create(name, 100)->data(), 1, 100);  // unlocked again at once
  EXPECT_THAT(refusalOf([&] { FrameRingWriter(name, shapeOf()); }), HasSubstr("is no ring of frames"));
  EXPECT_TRUE(SharedMemory::open(name, SharedMemory::Access::read));
  SharedMemory::remove(name);
}

TEST(FrameRing, RefusesARingThatIsTooSmall)
{
  const std::vector<std::byte> head = headOf(shapeOf());
  ForeignMemory cut(frame_ring::ringBytes(shapeOf()) - 1);
  std::memcpy(cut.data(), head.data(), head.size());
  EXPECT_THAT(refusalBySource(cut.name()), HasSubstr("is damaged"));
}

// Either a field's damage is seen, or the ring is read within its bounds (the address sanitizer would tell).
RC_GTEST_PROP(FrameRing, SurvivesADamagedHead, ())
{
  const FrameRingShape shape = shapeOf();
  static const std::vector<std::byte> kHead = headOf(shape);
  ForeignMemory ring(frame_ring::ringBytes(shape));
  std::memcpy(ring.data(), kHead.data(), kHead.size());
  const auto at = *rc::gen::inRange<std::size_t>(0, sizeof(FrameRingHeader));
  ring.data()[at] = static_cast<std::byte>(*rc::gen::inRange(0, 256));
  try {
    FrameRingSource source("shm:" + ring.name(), patient(-1.0));
    VideoFrame frame;
    source.read(frame);
  } catch (const FileError& error) {
    RC_ASSERT(std::string(error.what()).find(ring.name()) != std::string::npos);
  }
}

}  // namespace
}  // namespace eyeslam::files
