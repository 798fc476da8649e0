// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace eyeslam::files {

/// A named object of POSIX shared memory, mapped whole. One program writes it, and holds a lock on it that ends with
/// the program, however that ends.
class SharedMemory {
 public:
  SharedMemory() = default;
  ~SharedMemory();
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;

  /// Makes a new object of zeros and locks it. @param name  without slash
  /// @return nothing where the name is taken
  /// @throws std::system_error  for any other reason
  static std::optional<SharedMemory> create(const std::string& name, std::size_t bytes);
  enum class Access { read, write };
  /// @return nothing where there is none of that name
  /// @throws std::system_error  for any other reason
  static std::optional<SharedMemory> open(const std::string& name, Access access);
  /// The object stays for those who have it mapped.
  static void remove(const std::string& name) noexcept;

  /// Takes the writer's lock. @return false where a living program has it
  bool lock() noexcept;
  /// Whether a living program has the writer's lock.
  bool isLocked() const noexcept;

  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  SharedMemory(int descriptor, std::size_t bytes, Access access);

  int descriptor_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace eyeslam::files
