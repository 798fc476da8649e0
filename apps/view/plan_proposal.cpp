// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/plan_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "command_line/clocks.h"
#include "eyeslam/files/plan_file.h"
#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/servo/plan_messages.h"
#include "view/command_words.h"

namespace eyeslam::apps {
namespace {

messaging::Hash hashIn(const burn_plan_t& message)
{
  messaging::Hash hash{};
  std::copy(std::begin(message.hash), std::end(message.hash), hash.begin());
  return hash;
}

}  // namespace

std::string hexOf(const messaging::Hash& hash)
{
  std::string hex;
  for (const std::uint8_t byte : hash) hex += fmt::format("{:02x}", byte);
  return hex;
}

std::string PlanProposal::read(const std::string& file, std::int64_t map_id)
{
  const fixtures::BurnPlan plan = files::readPlan(file);
  try {
    burn_plan_t message = servo::planMessage(plan, map_id);
    message.state = burn_plan_t::PROPOSED;
    message.utime = utimeNow();
    message_ = message;
  } catch (const fixtures::PlanError& error) {
    throw CommandError(fmt::format("propose {}: {}", file, error.what()));
  }
  return fmt::format("proposed: {} of {} targets may be burnt; hash {}", fixtures::validTargets(plan),
                     plan.targets.size(), hexOf(hashIn(*message_)));
}

messaging::Hash PlanProposal::named(const std::string& digits) const
{
  if (!message_) throw CommandError("approve: no plan is proposed");
  std::string lower = digits;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char digit) { return static_cast<char>(std::tolower(digit)); });
  if (lower.size() < kLeastDigits) {
    throw CommandError(
        fmt::format("approve {}: the first {} digits of the hash are wanted, or more", digits, kLeastDigits));
  }
  const messaging::Hash hash = hashIn(*message_);
  if (hexOf(hash).compare(0, lower.size(), lower) != 0) {
    throw CommandError(fmt::format("approve {}: the proposed plan's hash does not begin so", digits));
  }
  return hash;
}

}  // namespace eyeslam::apps
