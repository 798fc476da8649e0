// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/line_reader.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace eyeslam::apps {

void LineReader::wait(int timeout_ms)
{
  pollfd input{ended_ ? -1 : descriptor_, POLLIN, 0};  // -1: only the time counts
  if (poll(&input, 1, timeout_ms) <= 0 || input.revents == 0) return;
  std::array<char, 4096> bytes{};
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  if (count > 0) text_.append(bytes.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) ended_ = true;
}

std::optional<std::string> LineReader::next()
{
  std::size_t end = text_.find('\n');
  if (end == std::string::npos && (ended_ || text_.size() >= kLongest)) end = text_.size();
  if (end == std::string::npos || text_.empty()) return std::nullopt;
  std::string line = text_.substr(0, end);
  text_.erase(0, end + 1);
  return line;
}

}  // namespace eyeslam::apps
