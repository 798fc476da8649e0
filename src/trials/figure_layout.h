// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::trials {

// How the report's figures are laid out, px.
inline constexpr double kFigureWidth = 1080.0;
inline constexpr double kPanelGap = 24.0;   ///< between panels side by side
inline constexpr double kAxisWidth = 62.0;  ///< left of a plot, for ticks and label

}  // namespace eyeslam::trials
