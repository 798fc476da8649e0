// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace eyeslam::files {
namespace {

[[noreturn]] void fail() { throw std::system_error(errno, std::generic_category()); }

// Locks of an open file description, not of a process: they hold between threads too.
struct flock wholeFile(short type)
{
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

SharedMemory::SharedMemory(int descriptor, std::size_t bytes, Access access) : descriptor_(descriptor), size_(bytes)
{
  if (bytes == 0) return;  // its writer has not given it a size yet
  const int protection = access == Access::write ? PROT_READ | PROT_WRITE : PROT_READ;
  void* const mapped = mmap(nullptr, bytes, protection, MAP_SHARED, descriptor, 0);
  if (mapped == MAP_FAILED) fail();  // the destructor does not run: nothing is mapped, the descriptor is the caller's
  data_ = static_cast<std::byte*>(mapped);
}

SharedMemory::~SharedMemory()
{
  if (data_ != nullptr) munmap(data_, size_);
  if (descriptor_ >= 0) close(descriptor_);
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0))
{}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept
{
  std::swap(descriptor_, other.descriptor_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

std::optional<SharedMemory> SharedMemory::create(const std::string& name, std::size_t bytes)
{
  const int descriptor = shm_open(("/" + name).c_str(), O_CREAT | O_EXCL | O_RDWR, S_IRUSR | S_IWUSR);
  if (descriptor < 0 && errno == EEXIST) return std::nullopt;
  if (descriptor < 0) fail();
  SharedMemory memory;
  memory.descriptor_ = descriptor;
  try {
    // Reserved at once: a full /dev/shm is an error now, not a signal in the middle of a frame.
    errno = posix_fallocate(descriptor, 0, static_cast<off_t>(bytes));
    if (errno != 0 || !memory.lock()) fail();
    SharedMemory mapped(descriptor, bytes, Access::write);
    memory.descriptor_ = -1;
    return mapped;
  } catch (const std::system_error&) {
    remove(name);
    throw;
  }
}

std::optional<SharedMemory> SharedMemory::open(const std::string& name, Access access)
{
  const int descriptor = shm_open(("/" + name).c_str(), access == Access::write ? O_RDWR : O_RDONLY, 0);
  if (descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor < 0) fail();
  SharedMemory memory;
  memory.descriptor_ = descriptor;
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) fail();
  SharedMemory mapped(descriptor, static_cast<std::size_t>(status.st_size), access);
  memory.descriptor_ = -1;
  return mapped;
}

void SharedMemory::remove(const std::string& name) noexcept { shm_unlink(("/" + name).c_str()); }

bool SharedMemory::lock() noexcept
{
  struct flock lock = wholeFile(F_WRLCK);
  return fcntl(descriptor_, F_OFD_SETLK, &lock) == 0;
}

bool SharedMemory::isLocked() const noexcept
{
  struct flock lock = wholeFile(F_RDLCK);
  return fcntl(descriptor_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace eyeslam::files
