// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace eyeslam::retina {

/// SHA-256 over bytes and numbers, the numbers little-endian: the same on every machine.
class Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const std::uint8_t* bytes, std::size_t count);
  template <class Unsigned>
  void addNumber(Unsigned number)
  {
    std::array<std::uint8_t, sizeof(Unsigned)> bytes{};
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(number & 0xFFU);
      number = static_cast<Unsigned>(number >> (sizeof(Unsigned) > 1 ? 8U : 0U));
    }
    add(bytes.data(), bytes.size());
  }
  /// As IEEE 754; -0 counts as 0.
  void addDouble(double value);

  /// Ends it: nothing may be added any more.
  Digest digest();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 64 hexadecimal digits.
std::string hexOf(const Sha256::Digest& digest);
/// The bytes of 64 hexadecimal digits; all 0 for any other text.
Sha256::Digest digestOf(const std::string& hex);

}  // namespace eyeslam::retina
