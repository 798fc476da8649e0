// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/map_hash.h"

#include <sodium.h>

#include <array>
#include <cstring>

namespace eyeslam::retina {
namespace {

class Sha256 {
 public:
  Sha256() { crypto_hash_sha256_init(&state_); }

  void add(const std::vector<std::uint8_t>& bytes) { crypto_hash_sha256_update(&state_, bytes.data(), bytes.size()); }

  template <class Unsigned>
  void addNumber(Unsigned number)
  {
    std::array<std::uint8_t, sizeof(Unsigned)> bytes{};
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(number & 0xFFU);
      number >>= 8U;
    }
    crypto_hash_sha256_update(&state_, bytes.data(), bytes.size());
  }

  void addDouble(double value)
  {
    value += 0.0;  // -0 and 0 are the same place
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    addNumber(bits);
  }

  std::string hex()
  {
    std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
    crypto_hash_sha256_final(&state_, digest.data());
    std::array<char, 2 * crypto_hash_sha256_BYTES + 1> text{};
    sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
    return text.data();
  }

 private:
  crypto_hash_sha256_state state_{};
};

}  // namespace

std::string hashOf(const VesselMap& map)
{
  Sha256 sha;
  sha.addNumber(static_cast<std::uint32_t>(map.width));
  sha.addNumber(static_cast<std::uint32_t>(map.height));
  sha.addDouble(map.origin_x);
  sha.addDouble(map.origin_y);
  sha.addDouble(map.px_per_cell);
  sha.add(map.probability);
  sha.add(map.seen);
  return sha.hex();
}

}  // namespace eyeslam::retina
