// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/sha256.h"

#include <sodium.h>

#include <cstring>

namespace eyeslam::retina {

struct Sha256::State {
  crypto_hash_sha256_state sodium{};
};

Sha256::Sha256() : state_(std::make_unique<State>()) { crypto_hash_sha256_init(&state_->sodium); }
Sha256::~Sha256() = default;

void Sha256::add(const std::uint8_t* bytes, std::size_t count)
{
  crypto_hash_sha256_update(&state_->sodium, bytes, count);
}

void Sha256::addDouble(double value)
{
  value += 0.0;  // -0 and 0 are the same place
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  addNumber(bits);
}

Sha256::Digest Sha256::digest()
{
  static_assert(std::tuple_size_v<Digest> == crypto_hash_sha256_BYTES);
  Digest digest{};
  crypto_hash_sha256_final(&state_->sodium, digest.data());
  return digest;
}

std::string hexOf(const Sha256::Digest& digest)
{
  std::array<char, 2 * crypto_hash_sha256_BYTES + 1> text{};
  sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
  return text.data();
}

Sha256::Digest digestOf(const std::string& hex)
{
  Sha256::Digest digest{};
  std::size_t bytes = 0;
  const bool whole =
      sodium_hex2bin(digest.data(), digest.size(), hex.data(), hex.size(), nullptr, &bytes, nullptr) == 0;
  if (!whole || bytes != digest.size()) digest.fill(0);
  return digest;
}

}  // namespace eyeslam::retina
