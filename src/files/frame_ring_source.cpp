// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/frame_ring_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

#include "eyeslam/retina/units.h"

namespace eyeslam::files {
namespace {

// A frame is seen so late at most; looking costs 1 us.
constexpr std::chrono::microseconds kPause{250};
constexpr double kOpeningPause_s = 0.02;
constexpr std::int64_t kLongestExposure_us = 60'000'000;

// Of a damaged field too.
int number(std::uint32_t value) { return static_cast<int>(std::min(value, std::uint32_t{1} << 20U)); }

// The shape that a ring's header claims; FrameRingShape's own limits are checked by its reader.
FrameRingShape shapeIn(const FrameRingHeader& header)
{
  FrameRingShape shape;
  shape.size = cv::Size(number(header.width), number(header.height));
  const bool known = (header.bytes_per_channel == 1 || header.bytes_per_channel == 2) &&
                     (header.channels == 1 || header.channels == 3);
  shape.type = known ? CV_MAKETYPE(header.bytes_per_channel == 1 ? CV_8U : CV_16U, number(header.channels)) : CV_32F;
  shape.frames_per_second = header.frames_per_second;
  shape.slots = number(header.slots);
  return shape;
}

// Acquire at each word: the state is not looked at again before all of them. On x86 that is a plain load.
void loadBytes(const std::byte* from, std::size_t bytes, std::uint8_t* to)
{
  const auto* words = reinterpret_cast<const std::atomic<std::uint64_t>*>(from);
  std::size_t done = 0;
  for (; done + sizeof(std::uint64_t) <= bytes; done += sizeof(std::uint64_t)) {
    const std::uint64_t word = (words++)->load(std::memory_order_acquire);
    std::memcpy(to + done, &word, sizeof word);
  }
  if (done == bytes) return;
  const std::uint64_t word = words->load(std::memory_order_acquire);
  std::memcpy(to + done, &word, bytes - done);
}

}  // namespace

FrameRingSource::FrameRingSource(const std::string& input, const VideoSourceOptions& options)
    : input_(input), options_(options)
{
  if (!options_.now) {  // without a clock nothing can be waited for
    options_.now = [] { return 0.0; };
    options_.patience = -1.0;
  }
  try {
    open();
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("{}: cannot be opened: {}", input, error.code().message()));
  }
}

void FrameRingSource::open()
{
  const double start = options_.now();
  while (!tryOpen()) {
    if (isStopped() || options_.now() - start > options_.patience) {
      throw FileError(input_ + ": no program writes such a ring of frames; start its writer first");
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(kOpeningPause_s));
  }
}

// Not yet there, or not yet made ready, or left behind by a writer that was killed: worth waiting for the next one.
bool FrameRingSource::tryOpen()
{
  std::optional<SharedMemory> memory = SharedMemory::open(frame_ring::nameOf(input_), SharedMemory::Access::read);
  if (!memory || memory->size() == 0) return false;
  memory_ = std::move(*memory);
  if (memory_.size() < sizeof(FrameRingHeader)) throw FileError(input_ + ": is no ring of frames; name another");
  const std::uint64_t magic = header().magic.load(std::memory_order_acquire);
  if (magic == 0) return false;
  if (magic != FrameRingHeader::kMagic) throw FileError(input_ + ": is no ring of frames; name another");
  if (header().version != FrameRingHeader::kVersion) {
    throw FileError(fmt::format("{}: is of version {}, this program reads {}; use a writer of this version", input_,
                                header().version, FrameRingHeader::kVersion));
  }
  shape_ = shapeIn(header());
  const std::string complaint = frame_ring::complaintAbout(shape_);
  if (!complaint.empty()) throw FileError(fmt::format("{}: is damaged: {}", input_, complaint));
  if (header().slot_bytes != frame_ring::slotBytes(shape_) || memory_.size() < frame_ring::ringBytes(shape_)) {
    throw FileError(input_ + ": is damaged: its pictures do not fit into it; start its writer anew");
  }
  return memory_.isLocked();
}

bool FrameRingSource::read(VideoFrame& frame)
{
  do {
    if (!readNewest(frame)) return false;
  } while (frame.number < first_);
  return options_.last_frame < 0 || frame.number <= options_.last_frame;
}

bool FrameRingSource::readNewest(VideoFrame& frame)
{
  const double start = options_.now();
  while (!copyNewest(frame)) {
    if (isStopped() || isOver()) return false;
    if (options_.now() - start > options_.patience) {
      notices_.push_back(fmt::format("{}: no frame for {:.3g} s; its writer has stopped", input_, options_.patience));
      return false;
    }
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

// What was written before the end is read first.
bool FrameRingSource::isOver()
{
  const bool ended = header().ended.load(std::memory_order_acquire) != 0;
  if (!ended && memory_.isLocked()) return false;
  if (header().frames.load(std::memory_order_acquire) != read_) return false;
  const char* const how = ended ? "ended" : "died";
  notices_.push_back(last_number_ < 0 ? fmt::format("{}: its writer {} before the first frame", input_, how)
                                      : fmt::format("{}: its writer {} after frame {}", input_, how, last_number_));
  return true;
}

// Nothing when there is none, or when the writer overtook the copy: by then there is a newer one.
bool FrameRingSource::copyNewest(VideoFrame& frame)
{
  const std::uint64_t frames = header().frames.load(std::memory_order_acquire);
  if (frames == read_) return false;
  const std::uint64_t newest = frames - 1;
  const std::byte* const slot = memory_.data() + sizeof(FrameRingHeader) +
                                newest % static_cast<std::uint64_t>(shape_.slots) * frame_ring::slotBytes(shape_);
  const auto& head = *reinterpret_cast<const FrameSlotHeader*>(slot);
  const std::uint64_t whole = 2 * newest + 2;
  if (head.state.load(std::memory_order_acquire) != whole) return false;
  const std::int64_t number = head.number.load(std::memory_order_acquire);
  const std::int64_t utime = head.utime.load(std::memory_order_acquire);
  const std::int64_t exposure_us = head.exposure.load(std::memory_order_acquire);
  frame.image.create(shape_.size, shape_.type);
  loadBytes(slot + sizeof(FrameSlotHeader), frame_ring::pictureBytes(shape_), frame.image.data);
  if (head.state.load(std::memory_order_relaxed) != whole) return false;

  if (number <= last_number_ || utime <= 0 || exposure_us < 0 || exposure_us > kLongestExposure_us)
    throw FileError(fmt::format("{}: the frame after {} bears an impossible number or time", input_, last_number_));
  left_out_ += static_cast<std::int64_t>(newest - read_);
  if (last_number_ < 0) first_utime_ = utime;
  read_ = newest + 1;
  last_number_ = number;
  frame.number = number;
  frame.t = kMicro * static_cast<double>(utime - first_utime_);
  frame.utime = utime;
  frame.exposure = kMicro * static_cast<double>(exposure_us);
  return true;
}

}  // namespace eyeslam::files
