// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace eyeslam::files {

/// A file that cannot be read or written: one line that names it and says what would be right.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace eyeslam::files
