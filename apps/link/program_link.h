// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/link.h"

namespace eyeslam::apps {

/// `--lcm` and `--key` (contracts, section 2).
struct LinkArguments {
  std::string url;  ///< empty = LCM_DEFAULT_URL
  std::string key;  ///< file, or empty
};

void addLinkOptions(CLI::App& app, LinkArguments& arguments);

/// Not 0, and different in every run.
std::int64_t newSession();

/// Now, by both clocks, as Link::drain wants it.
messaging::ReceiveTime receiveTime();

/// What the key's file holds; none where there is no file. @throws UsageError
std::optional<messaging::Key> keyOf(const LinkArguments& arguments);

/// @throws UsageError  the URL or the key cannot be used
messaging::Link openLink(const LinkArguments& arguments, std::int64_t session);

/// An address on this computer alone, for this process and the programs that it starts. @param offset  of its port: for
/// several in a row
std::string privateUrl(int offset = 0);

/// One line for people about unsigned messages; empty with a key.
std::string unsignedNotice(const LinkArguments& arguments);

/// What a program runs with, for the log.
struct RunConfiguration {
  std::string yaml;
  std::string hash;
};

/// One MARK. @param kind  as in mark_t; @param program  as it is called
void sendMark(messaging::Publisher<mark_t>& marks, std::int16_t kind, const std::string& program,
              const RunConfiguration& configuration);

/// MARK at start and end: the log then tells which program ran how.
class RunMark {
 public:
  /// @param program        as it is called
  /// @param configuration  empty where there is none
  RunMark(messaging::Link& link, std::string program, const RunConfiguration& configuration);
  ~RunMark();
  RunMark(const RunMark&) = delete;
  RunMark& operator=(const RunMark&) = delete;

 private:
  std::string program_;
  messaging::Publisher<mark_t> marks_;
};

}  // namespace eyeslam::apps
