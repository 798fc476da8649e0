// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::apps {

/// Ctrl-C (SIGINT) or SIGTERM as a question instead of an end: the program asks between two frames, keeps what was
/// done, and ends in order. A second signal ends it at once. Construct it before any thread is started.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether a signal has come, now or before.
  bool requested();

  /// While it lives, a signal ends the program at once, as usual: around a call that may take long and cannot be asked,
  /// before there is anything to keep.
  class Suspension {
   public:
    explicit Suspension(const Interruption& interruption);
    ~Suspension();
    Suspension(const Suspension&) = delete;
    Suspension& operator=(const Suspension&) = delete;

   private:
    bool blocked_;
  };

 private:
  int descriptor_ = -1;  // the signals can be read from it
  bool requested_ = false;
};

}  // namespace eyeslam::apps
