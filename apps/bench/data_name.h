// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace eyeslam::apps {

/// What a table calls a sequence's folder or a picture: the last part of its path.
inline std::string nameOf(const std::string& data)
{
  const std::filesystem::path path = std::filesystem::path(data).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace eyeslam::apps
