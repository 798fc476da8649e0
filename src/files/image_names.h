// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace eyeslam::files {

/// Names in the order in which people number them: im9.png before im10.png.
bool naturalLess(const std::string& a, const std::string& b);

/// Whether the ending is that of an image OpenCV reads.
bool isImageName(const std::string& path);

/// Whether a path holds wildcards and does not exist as it stands.
bool isGlob(const std::string& path);

/// The images of a folder or a glob, in natural order; other files are left out.
/// @throws FileError when there is none
std::vector<std::string> imagesOf(const std::string& folder_or_glob);

}  // namespace eyeslam::files
