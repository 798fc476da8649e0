// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/scratch_folder.h"

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace eyeslam::apps {

ScratchFolder::ScratchFolder(const std::string& program)
{
  std::string pattern = (std::filesystem::temp_directory_path() / (program + "_XXXXXX")).string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw std::runtime_error(pattern + ": no folder can be made there; set TMPDIR to where there is room");
  folder_ = pattern;
}

ScratchFolder::~ScratchFolder()
{
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace eyeslam::apps
