// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/frame_ring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <system_error>

namespace eyeslam::files {
namespace frame_ring {
namespace {

constexpr int kLargestSide = 16384;  // px
constexpr int kMostSlots = 1024;
constexpr std::size_t kLongestName = 200;
const std::string kPrefix = "shm:";

bool isNameLetter(char letter)
{
  const bool alphanumeric =
      (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z');
  return alphanumeric || letter == '-' || letter == '_' || letter == '.';
}

bool isSide(int px) { return px >= 1 && px <= kLargestSide; }

}  // namespace

std::string nameOf(const std::string& input)
{
  std::string name = input.compare(0, kPrefix.size(), kPrefix) == 0 ? input.substr(kPrefix.size()) : input;
  const bool plain = std::all_of(name.begin(), name.end(), isNameLetter);
  if (!plain || name.empty() || name.size() > kLongestName || name.front() == '.') {
    throw FileError(input + ": a name of letters, digits, '-', '_' and '.' is wanted, as in shm:eye");
  }
  return name;
}

std::size_t pictureBytes(const FrameRingShape& shape)
{
  return static_cast<std::size_t>(shape.size.width) * static_cast<std::size_t>(shape.size.height) *
         static_cast<std::size_t>(CV_ELEM_SIZE(shape.type));
}

std::size_t slotBytes(const FrameRingShape& shape)
{
  return sizeof(FrameSlotHeader) + (pictureBytes(shape) + 7) / 8 * 8;
}

std::size_t ringBytes(const FrameRingShape& shape)
{
  return sizeof(FrameRingHeader) + static_cast<std::size_t>(shape.slots) * slotBytes(shape);
}

std::string complaintAbout(const FrameRingShape& shape)
{
  const int depth = CV_MAT_DEPTH(shape.type), channels = CV_MAT_CN(shape.type);
  if (!isSide(shape.size.width) || !isSide(shape.size.height))
    return fmt::format("{} x {} px; 1 to {} are possible", shape.size.width, shape.size.height, kLargestSide);
  if ((depth != CV_8U && depth != CV_16U) || (channels != 1 && channels != 3))
    return "pixels must have 8 or 16 bits and one or three channels";
  if (shape.slots < 2 || shape.slots > kMostSlots)
    return fmt::format("{} slots; 2 to {} are possible", shape.slots, kMostSlots);
  if (!(shape.frames_per_second > 0.0 && shape.frames_per_second <= 1e5))
    return fmt::format("{} frames per second; above 0 to 100000 are possible", shape.frames_per_second);
  return {};
}

}  // namespace frame_ring

namespace {

// A ring whose writer is dead is ours to replace, a living writer's or another program's memory is not.
void removeStale(const std::string& name)
{
  std::optional<SharedMemory> old = SharedMemory::open(name, SharedMemory::Access::write);
  if (!old) return;
  if (!old->lock()) throw FileError(fmt::format("shm:{}: another program writes it; name another", name));
  const bool ours = old->size() >= sizeof(FrameRingHeader) &&
                    reinterpret_cast<const FrameRingHeader*>(old->data())->magic == FrameRingHeader::kMagic;
  if (!ours && old->size() > 0) throw FileError(fmt::format("shm:{}: is no ring of frames; name another", name));
  SharedMemory::remove(name);
}

SharedMemory createRing(const std::string& name, std::size_t bytes)
{
  constexpr int kAttempts = 3;  // two writers may remove the same stale ring
  try {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (std::optional<SharedMemory> memory = SharedMemory::create(name, bytes)) return std::move(*memory);
      removeStale(name);
    }
  } catch (const std::system_error& error) {
    throw FileError(
        fmt::format("shm:{}: {} bytes of shared memory cannot be had: {}", name, bytes, error.code().message()));
  }
  throw FileError(fmt::format("shm:{}: another program makes it at the same time; name another", name));
}

void writeShape(FrameRingHeader& header, const FrameRingShape& shape)
{
  header.version = FrameRingHeader::kVersion;
  header.slots = static_cast<std::uint32_t>(shape.slots);
  header.width = static_cast<std::uint32_t>(shape.size.width);
  header.height = static_cast<std::uint32_t>(shape.size.height);
  header.bytes_per_channel = static_cast<std::uint32_t>(CV_ELEM_SIZE1(shape.type));
  header.channels = static_cast<std::uint32_t>(CV_MAT_CN(shape.type));
  header.frames_per_second = shape.frames_per_second;
  header.slot_bytes = frame_ring::slotBytes(shape);
}

// Release at each word: none may be seen before the state that says "being written". On x86 that is a plain store.
void storeRow(std::atomic<std::uint64_t>*& to, std::uint64_t& rest, std::size_t& filled, const std::uint8_t* from,
              std::size_t bytes)
{
  while (bytes > 0) {
    const std::size_t taken = std::min(bytes, sizeof rest - filled);
    std::memcpy(reinterpret_cast<std::uint8_t*>(&rest) + filled, from, taken);
    from += taken;
    bytes -= taken;
    filled += taken;
    if (filled < sizeof rest) return;
    (to++)->store(rest, std::memory_order_release);
    filled = 0;
  }
}

void storePicture(std::byte* slot, const cv::Mat& image)
{
  auto* to = reinterpret_cast<std::atomic<std::uint64_t>*>(slot + sizeof(FrameSlotHeader));
  const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  std::uint64_t rest = 0;
  std::size_t filled = 0;
  for (int y = 0; y < image.rows; ++y) storeRow(to, rest, filled, image.ptr(y), row_bytes);
  if (filled > 0) to->store(rest, std::memory_order_release);
}

}  // namespace

FrameRingWriter::FrameRingWriter(const std::string& name, const FrameRingShape& shape)
    : name_(frame_ring::nameOf(name)), shape_(shape)
{
  const std::string complaint = frame_ring::complaintAbout(shape);
  if (!complaint.empty()) throw FileError(fmt::format("shm:{}: {}", name_, complaint));
  memory_ = createRing(name_, frame_ring::ringBytes(shape));
  header_ = new (memory_.data()) FrameRingHeader{};
  writeShape(*header_, shape);
  header_->magic.store(FrameRingHeader::kMagic, std::memory_order_release);
}

FrameRingWriter::~FrameRingWriter()
{
  header_->ended.store(1, std::memory_order_release);
  SharedMemory::remove(name_);
}

bool FrameRingWriter::write(const cv::Mat& image, const FrameStampInRing& stamp) noexcept
{
  if (image.size() != shape_.size || image.type() != shape_.type) return false;
  if (stamp.number < 0 || stamp.utime <= 0 || stamp.exposure_us < 0) return false;
  const std::uint64_t index = frames_ % static_cast<std::uint64_t>(shape_.slots);
  std::byte* const slot = memory_.data() + sizeof(FrameRingHeader) + index * frame_ring::slotBytes(shape_);
  auto& head = *reinterpret_cast<FrameSlotHeader*>(slot);
  head.state.store(2 * frames_ + 1, std::memory_order_release);
  head.number.store(stamp.number, std::memory_order_release);
  head.utime.store(stamp.utime, std::memory_order_release);
  head.exposure.store(stamp.exposure_us, std::memory_order_release);
  storePicture(slot, image);
  head.state.store(2 * frames_ + 2, std::memory_order_release);
  header_->frames.store(++frames_, std::memory_order_release);
  return true;
}

}  // namespace eyeslam::files
