// SPDX-License-Identifier: GPL-3.0-or-later
#include "link/program_link.h"

#include <fmt/format.h>
#include <unistd.h>

#include <random>
#include <stdexcept>
#include <utility>

#include "command_line/clocks.h"
#include "command_line/program.h"
#include "command_line/version.h"

namespace eyeslam::apps {

void addLinkOptions(CLI::App& app, LinkArguments& arguments)
{
  app.add_option("--lcm", arguments.url, "LCM URL; default LCM_DEFAULT_URL, else this computer only")->type_name("URL");
  app.add_option("--key", arguments.key, "Key that signs the messages: 64 hexadecimal digits")->type_name("FILE");
}

std::int64_t newSession()
{
  std::random_device random;
  const std::uint64_t bits = (static_cast<std::uint64_t>(random()) << 32U) | random();
  return static_cast<std::int64_t>(bits >> 1U) | 1;
}

messaging::ReceiveTime receiveTime() { return {static_cast<std::int64_t>(1e6 * monotonicSeconds()), utimeNow()}; }

std::optional<messaging::Key> keyOf(const LinkArguments& arguments)
try {
  if (arguments.key.empty()) return {};
  return messaging::readKey(arguments.key);
} catch (const std::runtime_error& error) {
  throw UsageError(error.what());
}

messaging::Link openLink(const LinkArguments& arguments, std::int64_t session)
try {
  return messaging::Link(arguments.url, session, keyOf(arguments));
} catch (const std::runtime_error& error) {
  throw UsageError(error.what());
}

std::string privateUrl(int offset)
{
  return fmt::format("udpm://239.255.76.67:{}?ttl=0", 20'000 + (getpid() + offset) % 40'000);
}

std::string unsignedNotice(const LinkArguments& arguments)
{
  return arguments.key.empty() ? "no --key FILE: messages are unsigned and stay on this computer" : "";
}

void sendMark(messaging::Publisher<mark_t>& marks, std::int16_t kind, const std::string& program,
              const RunConfiguration& configuration)
{
  mark_t message{};
  message.utime = utimeNow();
  message.kind = kind;
  message.sender = program;
  message.version = kVersion;
  message.configuration = configuration.yaml;
  message.configuration_hash = configuration.hash;
  marks.publish(message, message.utime);
}

RunMark::RunMark(messaging::Link& link, std::string program, const RunConfiguration& configuration)
    : program_(std::move(program)), marks_(link)
{
  sendMark(marks_, mark_t::START, program_, configuration);
}

RunMark::~RunMark()
{
  try {
    sendMark(marks_, mark_t::STOP, program_, {});
  } catch (const std::exception&) {  // the end of a run is not held up by its note
  }
}

}  // namespace eyeslam::apps
