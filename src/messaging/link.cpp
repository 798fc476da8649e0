// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/link.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace eyeslam::messaging {
namespace {

constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

std::string chosenUrl(const std::string& url)
{
  if (!url.empty()) return url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment && *from_environment ? from_environment : kDefaultUrl;
}

bool startsWith(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

bool isMulticast(const std::string& url) { return startsWith(url, "udpm://"); }

// LCM takes the default for a missing ttl (0), ignores what it does not know, and the last of two counts.
bool staysOnThisComputer(const std::string& url)
{
  if (startsWith(url, "memq://") || startsWith(url, "file://")) return true;
  if (!isMulticast(url)) return false;
  for (std::size_t at = url.find("ttl="); at != std::string::npos; at = url.find("ttl=", at + 1)) {
    const std::size_t end = url.find('&', at);
    if (url.substr(at + 4, end == std::string::npos ? end : end - at - 4) != "0") return false;
  }
  return true;
}

// `udpm://ADDRESS` is taken for good by LCM and then sends to port 0.
bool lacksPort(const std::string& url)
{
  const std::size_t start = url.find("://") + 3;
  const std::string address = url.substr(start, url.find('?') == std::string::npos ? url.npos : url.find('?') - start);
  return !address.empty() && address.find(':') == std::string::npos;
}

// What the system grants of a generous buffer: a burst of 200 small messages overflows its default, and LCM complains
// where it is granted less than it asked for.
int receiveBufferBytes()
{
  constexpr int kWanted = 8'000'000;
  const int probe = ::socket(AF_INET, SOCK_DGRAM, 0);
  if (probe < 0) return 0;
  int granted = 0;
  socklen_t size = sizeof(granted);
  ::setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &kWanted, sizeof(kWanted));
  ::getsockopt(probe, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  ::close(probe);
  return std::min(granted, kWanted);
}

std::string withReceiveBuffer(const std::string& url)
{
  if (!isMulticast(url) || url.find("recv_buf_size=") != std::string::npos) return url;
  const char* joint = url.find('?') == std::string::npos ? "?" : "&";
  return url + joint + "recv_buf_size=" + std::to_string(receiveBufferBytes());
}

void check(const std::string& url, bool has_key)
{
  if (url.find("://") == std::string::npos) {
    throw std::runtime_error("LCM URL '" + url +
                             "': expected udpm://ADDRESS:PORT?ttl=0, memq:// or file://PATH?mode=w");
  }
  if (isMulticast(url) && lacksPort(url)) {
    throw std::runtime_error("LCM URL '" + url + "' has no port: write " + kDefaultUrl);
  }
  if (!has_key && !staysOnThisComputer(url)) {
    throw std::runtime_error("LCM URL '" + url +
                             "' leaves this computer, and there is no key: give --key FILE or ttl=0");
  }
}

}  // namespace

Link::Link(const std::string& url, std::int64_t session, const std::optional<Key>& key)
    : url_(chosenUrl(url)), session_(session)
{
  check(url_, key.has_value());
  if (key) authenticator_.emplace(*key);
  if (startsWith(url_, "file://")) file_ = std::make_unique<std::mutex>();
  lcm_ = std::make_unique<lcm::LCM>(withReceiveBuffer(url_));
  // A multicast link is not asked for its descriptor, which would start a receiver; others say good() without a peer.
  if (!lcm_->good() || (!isMulticast(url_) && lcm_->getFileno() < 0)) {
    throw std::runtime_error(
        "LCM URL '" + url_ + "' cannot be used" +
        (isMulticast(url_) ? "; is there a multicast route? (ip route add 224.0.0.0/4 dev lo)" : ""));
  }
}

Link::~Link() = default;

bool Link::send(const std::string& channel, const std::uint8_t* bytes, std::size_t size)
{
  const auto writing = file_ ? std::unique_lock(*file_) : std::unique_lock<std::mutex>();
  return lcm_->publish(channel, bytes, static_cast<unsigned int>(size)) == 0;
}

bool Link::wait(int timeout_ms)
{
  pollfd descriptor{lcm_->getFileno(), POLLIN, 0};
  return ::poll(&descriptor, 1, timeout_ms) > 0;
}

std::size_t Link::drain(const ReceiveTime& now, std::size_t most)
{
  now_ = now;
  clocks_ = nullptr;
  return handle(most);
}

std::size_t Link::drain(Clocks clocks, std::size_t most)
{
  clocks_ = clocks;
  return handle(most);
}

std::size_t Link::handle(std::size_t most)
{
  std::size_t handled = 0;
  while (handled < most && lcm_->handleTimeout(0) > 0) ++handled;
  return handled;
}

bool Link::step()
{
  now_.reset();
  clocks_ = nullptr;
  return lcm_->handleTimeout(0) > 0;
}

}  // namespace eyeslam::messaging
