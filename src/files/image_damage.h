// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eyeslam::files {

/// What is wrong with an encoded picture, in words, or empty. Decoders do not tell: a cut JPEG comes back grey below
/// the cut, and libpng writes to standard error. PNG: structure and checksum of every chunk; JPEG: markers up to the
/// end of the image; other formats: only that there is something.
std::string damageIn(const std::vector<std::uint8_t>& bytes);

}  // namespace eyeslam::files
