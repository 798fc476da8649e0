// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace eyeslam::files {

/// How large a full-resolution map pixel is, and who says so. Never guessed (contracts, section 1).
struct PixelSize {
  std::optional<double> um_per_px;  ///< um, > 0; nothing = unknown
  std::string source;               ///< "--um-per-px", the path of a meta.json, or "unknown"
};

/// The given value, else that of a `meta.json` beside the input (in an image folder: in it), else unknown.
/// @throws FileError when that file's value is no positive number
PixelSize pixelSizeOf(const std::string& input, std::optional<double> given_um_per_px);

}  // namespace eyeslam::files
