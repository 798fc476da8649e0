// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/authentication.h"

#include <sodium.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace eyeslam::messaging {
namespace {

constexpr const char* kRemedy = " (make one with: od -An -tx1 -N32 /dev/urandom > FILE && chmod 600 FILE)";

std::string readAll(const std::string& path)
{
  std::ifstream file(path);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file.is_open() || file.bad()) {
    throw std::runtime_error("key file '" + path + "': " + std::strerror(errno) + kRemedy);
  }
  return text;
}

void refuseWhenOthersCanRead(const std::string& path)
{
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && (status.st_mode & (S_IRGRP | S_IROTH)) != 0) {
    throw std::runtime_error("key file '" + path + "' can be read by other users: chmod 600 '" + path + "'");
  }
}

}  // namespace

Key readKey(const std::string& path)
{
  const std::string text = readAll(path);
  refuseWhenOthersCanRead(path);
  Key key;
  std::size_t size = 0;
  const char* end = nullptr;
  const int result = sodium_hex2bin(key.data(), key.size(), text.c_str(), text.size(), " \t\r\n", &size, &end);
  if (result != 0 || size != key.size() || end != text.c_str() + text.size()) {
    throw std::runtime_error("key file '" + path + "' is not 64 hexadecimal digits" + kRemedy);
  }
  return key;
}

Authenticator::Authenticator(const Key& key) : key_(key)
{
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be initialised");
}

Tag Authenticator::tag(std::string_view channel, const std::uint8_t* body, std::size_t size) const
{
  constexpr unsigned char kNul = 0;
  crypto_generichash_state state;
  crypto_generichash_init(&state, key_.data(), key_.size(), kTagBytes);
  crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(channel.data()), channel.size());
  crypto_generichash_update(&state, &kNul, 1);
  crypto_generichash_update(&state, body, size);
  Tag result;
  crypto_generichash_final(&state, result.data(), result.size());
  return result;
}

bool Authenticator::verifies(std::string_view channel, const std::uint8_t* message, std::size_t size) const
{
  if (size < kTagBytes) return false;
  const std::size_t body = size - kTagBytes;
  const Tag expected = tag(channel, message, body);
  return sodium_memcmp(expected.data(), message + body, kTagBytes) == 0;
}

}  // namespace eyeslam::messaging
