// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace eyeslam::files {

/// The bytes of a ring of frames in shared memory, for writers in other languages too; native byte order.
/// A header, then `slots` slots: a SlotHeader each, and the picture row by row without gaps, padded to 8 bytes.
/// Frame i of the ring (from 0) lies in slot i % slots. The writer holds a write lock (F_OFD_SETLK) on the whole
/// object for as long as it lives.
struct FrameRingHeader {
  static constexpr std::uint64_t kMagic = 0x676E6952534D5945;  // "EYMSRing"
  static constexpr std::uint32_t kVersion = 1;

  std::atomic<std::uint64_t> magic;  ///< written last, so that no half-made ring is read
  std::uint32_t version;
  std::uint32_t slots;                ///< 2 to 1024
  std::uint32_t width;                ///< px
  std::uint32_t height;               ///< px
  std::uint32_t bytes_per_channel;    ///< 1 or 2
  std::uint32_t channels;             ///< 1 (grey) or 3 (blue, green, red)
  double frames_per_second;           ///< nominal, > 0
  std::uint64_t slot_bytes;           ///< from one slot to the next
  std::atomic<std::uint64_t> frames;  ///< whole frames written so far; the newest is this less one
  std::atomic<std::uint64_t> ended;   ///< 1 = the writer has ended on purpose
};

/// Before each picture. `state` is 2 i + 1 while frame i is written and 2 i + 2 when it is whole: a reader that finds
/// the same even number before and after its copy has a whole frame.
struct FrameSlotHeader {
  std::atomic<std::uint64_t> state;
  std::atomic<std::int64_t> number;    ///< the camera's, from 0, growing
  std::atomic<std::int64_t> utime;     ///< us since 1970, middle of the exposure
  std::atomic<std::int64_t> exposure;  ///< us, 0 = unknown
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free && sizeof(std::atomic<std::uint64_t>) == 8);
static_assert(sizeof(FrameRingHeader) == 64 && sizeof(FrameSlotHeader) == 32);

}  // namespace eyeslam::files
