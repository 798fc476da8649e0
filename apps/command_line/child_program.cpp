// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/child_program.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace eyeslam::apps {

std::string programFolder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path().string(); }

ChildProgram::ChildProgram(const std::string& path, const std::vector<std::string>& arguments) : path_(path)
{
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (const int error = posix_spawn(&id_, path.c_str(), nullptr, nullptr, pointers.data(), environ); error != 0) {
    throw std::runtime_error(fmt::format("{}: cannot be started: {}", path, std::strerror(error)));
  }
}

ChildProgram::~ChildProgram()
{
  if (id_ <= 0) return;
  kill(id_, SIGKILL);
  waitpid(id_, nullptr, 0);
}

bool ChildProgram::runs()
{
  if (id_ > 0 && waitpid(id_, nullptr, WNOHANG) == id_) id_ = -1;
  return id_ > 0;
}

void ChildProgram::interrupt()
{
  if (id_ <= 0) throw std::runtime_error(path_ + ": has ended by itself");
  kill(id_, SIGINT);
  int status = 0;
  waitpid(id_, &status, 0);
  id_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(path_ + ": did not end in order");
}

}  // namespace eyeslam::apps
