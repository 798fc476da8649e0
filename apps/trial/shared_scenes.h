// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "eyeslam/trials/trial_scene.h"
#include "trial/trial_list.h"

namespace eyeslam::apps {

/// Scenes that trials of one place share: made once, by whoever comes first while the others wait, and forgotten after
/// the last. They take seconds to make, and some hundred megabytes.
class SharedScenes {
 public:
  explicit SharedScenes(const std::vector<PlannedTrial>& trials);

  /// From any thread, once a trial.
  /// @throws files::FileError, std::invalid_argument  for every trial of the place
  std::shared_ptr<const trials::TrialScene> sceneOf(const PlannedTrial& trial);

 private:
  using Scene = std::shared_ptr<const trials::TrialScene>;  // shared by the trials that run on it
  struct Entry {
    std::size_t still_to_come = 0;
    std::shared_future<Scene> scene;
  };

  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace eyeslam::apps
