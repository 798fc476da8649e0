// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/files/log_writer.h"
#include "eyeslam/files/whole_file.h"
#include "support/encoded_message.h"
#include "support/temporary_folder.h"

namespace eyeslam::support {

constexpr std::int64_t kLogStart = 1'700'000'000'000'000;  // us since 1970

/// A log in a folder of its own, written event by event.
class WrittenLog {
 public:
  void add(const std::string& channel, const Bytes& bytes, std::int64_t utime)
  {
    writer_.append(channel, bytes.data(), bytes.size(), utime);
  }

  /// On its own channel.
  template <class Message>
  void add(const Message& message, std::int64_t utime)
  {
    add(messaging::channelOf<Message>(), encodedMessage(message), utime);
  }

  /// @return its path; nothing is added afterwards
  std::string finish()
  {
    writer_.finish();
    return path_;
  }

  std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  TemporaryFolder folder_;
  std::string path_ = folder_.path("log.lcm");
  files::LogWriter writer_{path_};
};

/// A message with its header filled and nothing else.
template <class Message>
Message headed(std::int64_t utime, std::int64_t seq, std::int64_t session = 7)
{
  Message message{};
  message.utime = utime;
  message.utime_sent = utime;
  message.seq = seq;
  message.session = session;
  return message;
}

}  // namespace eyeslam::support
