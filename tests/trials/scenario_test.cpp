// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "eyeslam/configuration/listing.h"
#include "support/temporary_folder.h"

namespace eyeslam::trials {
namespace {

using configuration::Assignment;
using configuration::ConfigurationError;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ScenarioFile : public ::testing::Test {
 protected:
  std::vector<Variant> read(const std::string& text, const std::vector<Assignment>& settings = {})
  {
    const std::string path = folder_.path("tracing.yaml");
    std::ofstream(path) << text;
    return readScenario(path, settings);
  }
  TrialSetting only(const std::string& text, const std::vector<Assignment>& settings = {})
  {
    const std::vector<Variant> variants = read(text, settings);
    EXPECT_EQ(variants.size(), 1U);
    return variants.front().setting;
  }
  std::vector<std::string> names(const std::string& text, const std::vector<Assignment>& settings = {})
  {
    std::vector<std::string> names;
    for (const Variant& variant : read(text, settings)) names.push_back(variant.name);
    return names;
  }
  std::string refusal(const std::string& text, const std::vector<Assignment>& settings = {})
  {
    try {
      read(text, settings);
    } catch (const ConfigurationError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }

  support::TemporaryFolder folder_;
};

TEST_F(ScenarioFile, SweepsAllCombinationsOfListsTheFirstOneSlowest)
{
  const std::vector<Variant> variants = read("aid: [soft, hard]\nduration_s: 7\nlambda: [0.1, 0.2, 0.3]\n");
  ASSERT_EQ(variants.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(variants[i].setting.scenario.aid, i < 3 ? "soft" : "hard");
    EXPECT_DOUBLE_EQ(variants[i].setting.scenario.lambda, 0.1 * static_cast<double>(1 + i % 3));
    EXPECT_EQ(variants[i].setting.scenario.duration_s, 7.0);
    EXPECT_EQ(variants[i].setting.scenario.name, "tracing");
  }
  EXPECT_EQ(variants[0].name, "aid=soft,lambda=0.1");
  EXPECT_EQ(variants[5].name, "aid=hard,lambda=0.3");
}

TEST_F(ScenarioFile, NamesAVariantByWhatIsSweptAlone)
{
  EXPECT_THAT(names("aid: hard\n"), ElementsAre(""));
  EXPECT_THAT(names("aid: hard\nmotion: [in_situ, jerky]\n"), ElementsAre("motion=in_situ", "motion=jerky"));
  EXPECT_THAT(names("retina: [procedural, /data/one.jpg, /data/two.jpg]\n"),
              ElementsAre("retina=procedural", "retina=one", "retina=two"));
}

TEST_F(ScenarioFile, SweepsWhatTheCommandLineListsAndLetsItReplaceASweep)
{
  EXPECT_THAT(names("aid: [none, hard]\n", {{"aid", "soft", "--set"}}), ElementsAre(""));
  EXPECT_THAT(names("aid: soft\n", {{"lambda", "0.1 0.4", "--set"}}), ElementsAre("lambda=0.1", "lambda=0.4"));
}

TEST_F(ScenarioFile, DoesNotSweepThePrescriptionsOwnLists)
{
  const std::string text =
      "task: laser\naid: [manual, automated]\nprescription: {pattern: {kind: rings, diameters_um: [1000, 2000], "
      "counts: "
      "[5, 11]}}\n";
  EXPECT_THAT(names(text), ElementsAre("aid=manual", "aid=automated"));
  EXPECT_EQ(read(text).front().setting.prescription.pattern.counts, "5 11");
}

TEST_F(ScenarioFile, DoesNotSweepTheWordsOfAPhotographsName)
{
  const std::string photograph = folder_.path("my photo.png");
  EXPECT_EQ(read("retina: " + photograph + "\n").size(), 2U) << "no such file: words";
  std::ofstream(photograph) << "a picture";
  EXPECT_EQ(only("retina: " + photograph + "\n").scenario.retina, photograph);
}

TEST_F(ScenarioFile, ReadsAnEmptyFileAsTheDefaults)
{
  EXPECT_EQ(configuration::hashOf(only("")), configuration::hashOf(presetBy(Scenario{})));
}

TEST_F(ScenarioFile, PresetsTheCameraByItsRate)
{
  const TrialSetting fast = only("camera_hz: 120\nlatency_ms: 5\n");
  EXPECT_EQ(fast.hardware.camera.fps, 120.0);
  EXPECT_EQ(fast.hardware.camera.width, 400);
  EXPECT_EQ(fast.hardware.camera.height, 304);
  EXPECT_EQ(fast.hardware.camera.exposure_ms, 4.0);
  EXPECT_EQ(fast.vision.tracker.frame.scale, 1.0);
  EXPECT_EQ(fast.servo.image_width_px, 400.0);
  EXPECT_EQ(fast.servo.image_height_px, 304.0);
  EXPECT_EQ(fast.vision.latency_high_ms, 5.0);
  EXPECT_EQ(fast.vision.latency_low_ms, 3.5);
  // A pulse wants a pose that is not older than latency and one frame.
  EXPECT_EQ(fast.servo.burning.interlocks.latency_ms, 5.0);
  EXPECT_EQ(fast.servo.burning.interlocks.frame_ms, 8.4);
  const TrialSetting usual = only("camera_hz: 30\n");
  EXPECT_EQ(usual.hardware.camera.width, 800);
  EXPECT_EQ(usual.hardware.camera.height, 608);
  EXPECT_EQ(usual.hardware.camera.exposure_ms, 8.0);
  EXPECT_EQ(usual.vision.tracker.frame.scale, tracking::TrackerOptions{}.frame.scale);
  EXPECT_EQ(usual.vision.latency_high_ms, 20.0);
  EXPECT_EQ(usual.servo.burning.interlocks.latency_ms, 20.0);
  EXPECT_EQ(usual.servo.burning.interlocks.frame_ms, 33.4);
}

TEST_F(ScenarioFile, PresetsByItsWords)
{
  EXPECT_EQ(only("condition: in_vivo\n").hardware.camera.condition, "human");
  EXPECT_EQ(only("condition: ex_vivo\n").hardware.camera.condition, "porcine");
  EXPECT_EQ(only("condition: paper\n").hardware.camera.condition, "paper");
  EXPECT_EQ(only("null_at: controller\n").servo.cycle.null_at, "controller");
  EXPECT_EQ(only("standoff_um: 450\n").servo.burning.standoff_um, 450.0);
  EXPECT_EQ(configuration::hashOf(only("motion: saccade\n").hardware.motion),
            configuration::hashOf(simulation::retinaMotionOptions("saccade")));
  const auto surgeon = [this](const std::string& text) { return only(text).hardware.hand.surgeon; };
  EXPECT_EQ(surgeon("task: laser\naid: manual\nlaser: {manual_gain_hz: 3.5}\n").gain_hz, 3.5);
  EXPECT_EQ(surgeon("task: laser\naid: automated\nlaser: {rest_um: 90}\n").dead_zone_um, 90.0);
  EXPECT_EQ(surgeon("task: trace\n").gain_hz, simulation::SurgeonOptions{}.gain_hz);
}

TEST_F(ScenarioFile, LetsDeepKeysOverrideWhatTheWordsPreset)
{
  // Whichever stands first.
  for (const char* text :
       {"camera_hz: 120\nhardware: {camera: {width: 640}}\n", "hardware: {camera: {width: 640}}\ncamera_hz: 120\n"}) {
    EXPECT_EQ(only(text).hardware.camera.width, 640);
    EXPECT_EQ(only(text).hardware.camera.height, 304);
  }
  EXPECT_EQ(only("latency_ms: 5\n", {{"vision.latency_low_ms", "4.5", "--set"}}).vision.latency_low_ms, 4.5);
}

TEST_F(ScenarioFile, RefusesByFileLineAndKey)
{
  EXPECT_THAT(refusal("task: trace\naidd: hard\n"),
              AllOf(HasSubstr("tracing.yaml:2:"), HasSubstr("aidd"), HasSubstr("aid")));
  EXPECT_THAT(refusal("camera_hz: 2\n"),
              AllOf(HasSubstr("tracing.yaml:1:"), HasSubstr("camera_hz"), HasSubstr("[5, 500]")));
  EXPECT_THAT(refusal("motion: [in_situ, waltz]\n"),
              AllOf(HasSubstr("motion"), HasSubstr("waltz"), HasSubstr("jerky")));
  EXPECT_THAT(refusal("servo: {cycle: {limits: {speed_mm_s: fast}}}\n"), HasSubstr("servo.cycle.limits.speed_mm_s"));
  EXPECT_THAT(refusal("aid: hard\naid: soft\n"), HasSubstr("'aid' stands twice"));
  EXPECT_THAT(refusal("task: trace\n", {{"speed", "1", "--set"}}), AllOf(HasSubstr("--set"), HasSubstr("speed")));
}

TEST_F(ScenarioFile, RefusesWordsThatDoNotGoTogether)
{
  EXPECT_THAT(refusal("task: laser\n"), AllOf(HasSubstr("aid"), HasSubstr("'hard'"), HasSubstr("automated")));
  EXPECT_THAT(refusal("task: hold\naid: manual\n"), AllOf(HasSubstr("aid"), HasSubstr("'manual'"), HasSubstr("hard")));
  EXPECT_THAT(refusal("aid: none\nfault: {kind: blackout}\n"), AllOf(HasSubstr("fault.kind"), HasSubstr("blackout")));
  EXPECT_EQ(refusal("aid: [none, hard]\n"), "accepted");
}

TEST_F(ScenarioFile, RefusesASweepThatNobodyWouldRun)
{
  std::string list = "[1";
  for (int i = 2; i <= 40; ++i) list += ", " + std::to_string(i);
  list += "]";
  EXPECT_THAT(refusal("duration_s: " + list + "\nsettling_s: " + list + "\n"), HasSubstr("more than 1000 variants"));
}

TEST_F(ScenarioFile, ComesBackWithTheSameHashFromTheYamlThatALogKeeps)
{
  for (const char* text : {"", "camera_hz: 120\nlatency_ms: 5\nmotion: saccade\naid: soft\nlambda: 0.123456789012345\n",
                           "task: laser\naid: automated\nprescription: {pattern: {kind: rings, diameters_um: [1000, "
                           "2000], counts: [5, 11]}}\n",
                           "retina: \"/pictures/the\\\"best\\\"\\\\one.jpg\"\n",
                           "task: hold\nfault: {kind: blackout, must: hold, reason: pose_old}\n"}) {
    const TrialSetting setting = only(text);
    const std::string yaml = configuration::yamlOf(setting, configuration::YamlComments::left_out);
    const TrialSetting again = settingOf("tracing", yaml);
    EXPECT_EQ(configuration::hashOf(again), configuration::hashOf(setting)) << text;
    EXPECT_EQ(again.scenario.name, "tracing");
  }
}

// A word of the file may have lost its meaning since; what it preset then stands in the log.
TEST_F(ScenarioFile, ComesBackWithDeepKeysThatDifferFromTheirPresets)
{
  const TrialSetting setting = only("camera_hz: 120\nhardware: {camera: {width: 640, exposure_ms: 1}}\n");
  const std::string yaml = configuration::yamlOf(setting, configuration::YamlComments::left_out);
  EXPECT_EQ(configuration::hashOf(settingOf("tracing", yaml)), configuration::hashOf(setting));
}

}  // namespace
}  // namespace eyeslam::trials
