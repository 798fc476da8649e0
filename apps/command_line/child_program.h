// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace eyeslam::apps {

/// The folder that this program lies in.
std::string programFolder();

/// A program that runs beside this one, and ends with this object.
class ChildProgram {
 public:
  /// @throws std::runtime_error  it cannot be started
  ChildProgram(const std::string& path, const std::vector<std::string>& arguments);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  bool runs();
  /// Ctrl-C for it, and waiting. @throws std::runtime_error  it did not end in order
  void interrupt();

 private:
  std::string path_;
  pid_t id_ = -1;
};

}  // namespace eyeslam::apps
