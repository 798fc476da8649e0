// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eyeslam::apps {

/// px
struct PictureSize {
  int width = 0;
  int height = 0;
};

/// "800x608", 64x48 to 4096x4096. @param option  that it belongs to @throws UsageError
PictureSize pictureSize(const std::string& option, const std::string& text);

}  // namespace eyeslam::apps
