// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/allocation_counter.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

// g++ says by macros that a sanitizer is at work, clang by features.
#if defined(__has_feature)
#define EYESLAM_HAS_FEATURE(name) __has_feature(name)
#else
#define EYESLAM_HAS_FEATURE(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || EYESLAM_HAS_FEATURE(address_sanitizer) || \
    EYESLAM_HAS_FEATURE(thread_sanitizer)
#define EYESLAM_COUNTS_MALLOC 0
#else
#define EYESLAM_COUNTS_MALLOC 1
#endif

namespace {

std::atomic<std::int64_t> count{0};

}  // namespace

namespace eyeslam::support {

std::int64_t allocations() { return count.load(); }

}  // namespace eyeslam::support

#if EYESLAM_COUNTS_MALLOC

// glibc's own allocator under the names it keeps for replacements like these; operator new calls malloc.
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept
{
  ++count;
  return __libc_malloc(size);
}

void* calloc(std::size_t members, std::size_t size) noexcept
{
  ++count;
  return __libc_calloc(members, size);
}

void* realloc(void* block, std::size_t size) noexcept
{
  ++count;
  return __libc_realloc(block, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept
{
  ++count;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept
{
  ++count;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}

}  // extern "C"

#else

void* operator new(std::size_t size)
{
  ++count;
  if (void* block = std::malloc(size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

#endif
