// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

extern char** environ;  // POSIX leaves it to the program

namespace eyeslam::support {

/// A program as a process, both of its outputs in one file; killed at the end unless it has ended.
class ChildProcess {
 public:
  /// @param words  the program, and its arguments
  /// @param file_limit  bytes of the largest file that it may write
  ChildProcess(std::vector<std::string> words, std::string output, rlim_t file_limit = RLIM_INFINITY)
      : output_(std::move(output))
  {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_t attributes;  // an ordinary process, whatever the caller is
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSCHEDULER);
    posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
    const sched_param ordinary{};
    posix_spawnattr_setschedparam(&attributes, &ordinary);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{file_limit, before.rlim_max};  // inherited
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_EQ(posix_spawn(&process_, arguments[0], &actions, &attributes, arguments.data(), environ), 0) << words[0];
    setrlimit(RLIMIT_FSIZE, &before);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~ChildProcess() { end(SIGKILL); }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void send(int signal) const
  {
    if (process_ > 0) kill(process_, signal);
  }
  /// Asks it to end so, and waits for it. @return exit status; -1 where a signal ended it
  int end(int signal)
  {
    send(signal);
    return wait();
  }
  int wait()
  {
    int status = -1;
    if (process_ > 0) waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  bool hasEnded()
  {
    if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) == process_) process_ = -1;
    return process_ <= 0;
  }
  std::string text() const
  {
    std::ostringstream text;
    text << std::ifstream(output_).rdbuf();
    return text.str();
  }

 private:
  std::string output_;
  pid_t process_ = -1;
};

}  // namespace eyeslam::support
