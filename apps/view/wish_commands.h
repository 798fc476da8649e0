// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/messaging/operator_messages.h"
#include "view/command_words.h"

namespace eyeslam::apps {

/// What a command may refer to, as vision says it now.
struct Sight {
  std::int64_t map_id = 0;                ///< 0 = no map yet
  std::optional<Eigen::Vector2d> tip_px;  ///< map frame; none where no tip is seen in a tracked frame
};

/// A command of the console, for its help.
struct CommandHelp {
  const char* usage;
  const char* does;
};

/// The commands that change what the human wants: modes, fixtures, zones, arming, stopping.
const std::vector<CommandHelp>& wishCommands();

/// Obeys one of them. What is asked is changed as a whole or not at all.
/// @return what to tell the human; none where the line is no such command
/// @throws CommandError
std::optional<std::string> obeyWish(const CommandWords& words, const Sight& sight, messaging::OperatorWish& wish);

}  // namespace eyeslam::apps
