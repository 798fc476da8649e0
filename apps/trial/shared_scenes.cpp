// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/shared_scenes.h"

#include <exception>

namespace eyeslam::apps {

SharedScenes::SharedScenes(const std::vector<PlannedTrial>& trials)
{
  for (const PlannedTrial& trial : trials) ++entries_[trial.place].still_to_come;
}

std::shared_ptr<const trials::TrialScene> SharedScenes::sceneOf(const PlannedTrial& trial)
{
  std::promise<Scene> promise;
  std::shared_future<Scene> scene;
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_.at(trial.place);
    first = !entry.scene.valid();
    if (first) entry.scene = promise.get_future().share();
    scene = entry.scene;
    if (--entry.still_to_come == 0) entries_.erase(trial.place);
  }
  if (first) {
    try {
      promise.set_value(std::make_shared<const trials::TrialScene>(trial.variant->setting, trial.seed));
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  }
  return scene.get();
}

}  // namespace eyeslam::apps
