// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/messaging/decoding.h"
#include "eyeslam/trials/trial.h"
#include "eyeslam/trials/trial_judge.h"
#include "support/encoded_message.h"

namespace eyeslam::support {

/// A message of a log, kept.
struct KeptEvent {
  std::int64_t number = 0, utime = 0;
  std::string channel, bytes;

  files::LogEvent event() const
  {
    return {number, utime, channel, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  }
  template <class Message>
  bool read(Message& message) const
  {
    return messaging::decode(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), message);
  }
  template <class Message>
  void write(const Message& message)
  {
    const Bytes encoded = encodedMessage(message);
    bytes.assign(encoded.begin(), encoded.end());
  }
  bool operator==(const KeptEvent& other) const
  {
    return number == other.number && utime == other.utime && channel == other.channel && bytes == other.bytes;
  }
};

/// A trial with frames of a quarter of the usual size, which take a quarter of the time.
struct ShortTrial {
  trials::TrialName name;
  trials::TrialSetting setting;
  std::shared_ptr<const trials::TrialScene> scene;
  std::vector<KeptEvent> events;
  trials::TrialJudge judge;  ///< that heard the trial itself
  bool swept_plane = false;

  /// @param yaml   keys of the scenario over one second of hard tracing
  /// @param where  a scene that somebody has made already, for it takes as long as a short trial
  explicit ShortTrial(const std::string& yaml, std::uint64_t seed = 3,
                      std::shared_ptr<const trials::TrialScene> where = nullptr)
      : name{"short", "aid=hard", seed}, scene(std::move(where))
  {
    const auto keys = [](const std::string& text) {
      return configuration::parseYaml("test", text, configuration::YamlLists::joined);
    };
    trials::Scenario scenario;
    scenario.name = "short";
    scenario.duration_s = 1.0;
    scenario.settling_s = 0.5;
    scenario = configuration::applied(scenario, keys(yaml));
    setting =
        configuration::applied(trials::presetBy(scenario),
                               keys("hardware: {camera: {width: 400, height: 304}}\nvision: {tracker: {frame: {scale: "
                                    "1}}}\nservo: {image_width_px: 400, image_height_px: 304}\n"));
    if (!scene) scene = std::make_shared<const trials::TrialScene>(setting, seed);
    judge = trials::TrialJudge(scene);
  }

  ShortTrial& run()
  {
    trials::Trial trial(setting, name, "1.2.3", *scene, [this](const files::LogEvent& event) {
      const auto* bytes = reinterpret_cast<const char*>(event.data);
      events.push_back({event.number, event.utime, std::string(event.channel), std::string(bytes, event.size)});
      judge.take(event);
    });
    while (trial.step()) continue;
    if (trial.servo()) swept_plane = trial.servo()->sweptPlane();
    return *this;
  }
};

/// A second of hard tracing, run once.
inline const ShortTrial& traced()
{
  static const ShortTrial trial = [] {
    ShortTrial hard("task: trace\naid: hard\n");
    hard.run();
    return hard;
  }();
  return trial;
}

}  // namespace eyeslam::support
