// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "eyeslam/configuration/listing.h"
#include "eyeslam/simulation/retina_motion_options.h"

namespace eyeslam::trials {

using configuration::Assignment;
using configuration::ConfigurationError;
using configuration::Field;

namespace {

constexpr double kSmallFrames_hz = 60.0;  // above it frames are half as wide and high (loop study, 1)
constexpr std::size_t kMostVariants = 1000;

// A key with its words: more than one are swept.
struct Choice {
  std::string key, origin;
  std::vector<std::string> words;
};

std::vector<std::string> wordsIn(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Patterns and places of a prescription are lists by themselves; a text alone may be empty, a photograph's path may
// have blanks.
bool isSwept(const Assignment& assignment)
{
  if (assignment.key.rfind("prescription.", 0) == 0) return false;
  if (assignment.key == "retina" && std::filesystem::is_regular_file(assignment.text)) return false;
  return wordsIn(assignment.text).size() > 1;
}

std::vector<Choice> choicesOf(const std::vector<Assignment>& assignments)
{
  std::vector<Choice> choices;
  for (const Assignment& assignment : assignments) {
    Choice choice{assignment.key, assignment.origin, {assignment.text}};
    if (isSwept(assignment)) choice.words = wordsIn(assignment.text);
    const auto known =
        std::find_if(choices.begin(), choices.end(), [&](const Choice& c) { return c.key == assignment.key; });
    if (known == choices.end()) {
      choices.push_back(choice);
    } else {
      *known = choice;
    }
  }
  return choices;
}

// The combination of that number, the first list slowest.
std::vector<Assignment> combination(const std::vector<Choice>& choices, std::size_t number)
{
  std::vector<Assignment> assignments;
  for (auto choice = choices.rbegin(); choice != choices.rend(); ++choice) {
    assignments.push_back({choice->key, choice->words[number % choice->words.size()], choice->origin});
    number /= choice->words.size();
  }
  std::reverse(assignments.begin(), assignments.end());
  return assignments;
}

// Of a photograph its name alone; a number has no extension.
std::string wordFor(const Assignment& assignment)
{
  return assignment.key == "retina" ? std::filesystem::path(assignment.text).stem().string() : assignment.text;
}

std::string nameOf(const std::vector<Choice>& choices, const std::vector<Assignment>& assignments)
{
  std::string name;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].words.size() < 2) continue;
    const std::string word = wordFor(assignments[i]);
    name += fmt::format("{}{}={}", name.empty() ? "" : ",", choices[i].key, word);
  }
  return name;
}

// The scenario's own keys decide on what all others start from.
std::vector<Assignment> scenarioPart(const std::vector<Assignment>& assignments)
{
  Scenario scenario;
  const std::vector<Field> fields = configuration::fieldsOf(scenario);
  std::vector<Assignment> part;
  std::copy_if(assignments.begin(), assignments.end(), std::back_inserter(part), [&](const Assignment& assignment) {
    return std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.key == assignment.key; });
  });
  return part;
}

[[noreturn]] void refuse(const Scenario& scenario, const std::string& what)
{
  throw ConfigurationError(fmt::format("{}: {}", scenario.name, what));
}

void check(const Scenario& scenario)
{
  const bool for_lasers = scenario.aid == "manual" || scenario.aid == "automated";
  if (scenario.isLaser() && !for_lasers)
    refuse(scenario, fmt::format("aid: '{}' is none for task laser; manual or automated is wanted", scenario.aid));
  if (!scenario.isLaser() && for_lasers)
    refuse(scenario,
           fmt::format("aid: '{}' is for task laser; none, filter, scaling, soft or hard is wanted", scenario.aid));
  if (scenario.isManual() && scenario.fault.kind != "none")
    refuse(scenario, fmt::format("fault.kind: '{}' needs an aid that it can befall", scenario.fault.kind));
}

TrialSetting settingFrom(const std::string& name, const std::vector<Assignment>& assignments)
{
  Scenario scenario;
  scenario.name = name;
  scenario = configuration::applied(scenario, scenarioPart(assignments));
  check(scenario);
  return configuration::applied(presetBy(scenario), assignments);
}

}  // namespace

TrialSetting presetBy(const Scenario& scenario)
{
  TrialSetting setting;
  setting.scenario = scenario;
  setting.hardware.motion = simulation::retinaMotionOptions(scenario.motion);
  simulation::EyeCameraOptions& eye = setting.hardware.camera;
  eye.condition = scenario.condition == "in_vivo" ? "human" : scenario.condition == "ex_vivo" ? "porcine" : "paper";
  eye.fps = scenario.camera_hz;
  eye.exposure_ms = std::min(8.0, 480.0 / scenario.camera_hz);
  eye.duration_s = 60.0 + scenario.duration_s;
  setting.vision.latency_high_ms = scenario.latency_ms;
  setting.vision.latency_low_ms = 0.7 * scenario.latency_ms;
  if (scenario.camera_hz > kSmallFrames_hz) {
    eye.width /= 2;
    eye.height /= 2;
    setting.vision.tracker.frame.scale = 1.0;
  }
  setting.servo.image_width_px = eye.width;
  setting.servo.image_height_px = eye.height;
  setting.servo.cycle.null_at = scenario.null_at;
  setting.servo.burning.standoff_um = scenario.standoff_um;
  setting.servo.burning.interlocks.latency_ms = scenario.latency_ms;
  setting.servo.burning.interlocks.frame_ms = std::ceil(1e4 / scenario.camera_hz) / 10.0;  // no shorter than it is
  simulation::SurgeonOptions& surgeon = setting.hardware.hand.surgeon;
  if (scenario.isLaser() && scenario.isManual()) surgeon.gain_hz = scenario.laser.manual_gain_hz;
  if (scenario.isLaser() && !scenario.isManual()) surgeon.dead_zone_um = scenario.laser.rest_um;
  return setting;
}

fixtures::BurnPrescription prescriptionAbout(const TrialSetting& setting, const Eigen::Vector2d& middle_px)
{
  fixtures::BurnPrescription asked = setting.prescription;
  if (asked.pattern.centre_px.empty())
    asked.pattern.centre_px = std::to_string(middle_px.x()) + " " + std::to_string(middle_px.y());
  return asked;
}

std::vector<Variant> readScenario(const std::string& path, const std::vector<Assignment>& settings)
{
  std::vector<Assignment> assignments = configuration::readYaml(path, configuration::YamlLists::joined);
  assignments.insert(assignments.end(), settings.begin(), settings.end());
  const std::vector<Choice> choices = choicesOf(assignments);
  std::size_t count = 1;
  for (const Choice& choice : choices) {
    count *= choice.words.size();
    if (count > kMostVariants) {
      throw ConfigurationError(
          fmt::format("{}: {}: more than {} variants; sweep fewer values", choice.origin, choice.key, kMostVariants));
    }
  }
  const std::string name = std::filesystem::path(path).stem().string();
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<Assignment> chosen = combination(choices, i);
    variants.push_back({nameOf(choices, chosen), settingFrom(name, chosen)});
  }
  return variants;
}

TrialSetting settingOf(const std::string& name, const std::string& yaml)
{
  return settingFrom(name, configuration::parseYaml(name, yaml));
}

}  // namespace eyeslam::trials
