// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/truth.h"

namespace eyeslam::files {

/// A test sequence without its video: what the files of contracts, section 5, say.
struct TestSequence {
  Truth truth;
  std::vector<double> tool_cover;  ///< one a frame: share of the picture that the shaft hides
  std::string condition;
  std::uint64_t seed = 0;
  double zoom = 1.0;       ///< map px per px of the picture it was rendered from
  std::vector<int> burns;  ///< frames in which a pulse began
};

/// Reads `meta.json`, `truth.csv` and, where they exist, `tool.csv` and `vessels.png` of a folder.
/// @throws FileError naming the file and what is wrong in it
TestSequence readTestSequence(const std::string& folder);

/// Writes all files but the video; `truth.poses`, `truth.tools` and `tool_cover` have an element a frame.
/// @throws FileError
void writeTestSequence(const TestSequence& sequence, const OutputFolder& folder);

/// The video of a sequence's folder: `video.mp4`, or `video.mkv` when that is what there is.
std::string videoOfTestSequence(const std::string& folder);

}  // namespace eyeslam::files
