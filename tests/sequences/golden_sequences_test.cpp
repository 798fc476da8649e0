// SPDX-License-Identifier: GPL-3.0-or-later
// Whole sequences, scored as the judge does: rendered ones always, those with truth of ../shared where they are.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "eyeslam/baselines/method.h"
#include "eyeslam/files/encoded_video.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/video_source.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/sequence_renderer.h"
#include "support/sequence_run.h"
#include "support/temporary_folder.h"

namespace eyeslam {
namespace {

using files::PoseScore;
using files::TruthPose;
using support::SequenceRun;

void report(const std::string& name, const SequenceRun& run)
{
  const PoseScore score = run.score();
  std::cout << name << ": " << score.rms_px << " px, " << score.rms_deg << " deg, largest " << score.max_px
            << " px, tracked " << score.tracked << ", normalised squared error " << run.normalisedSquaredError()
            << ", returns";
  for (const int frames : score.frames_to_return) std::cout << " " << frames;
  std::cout << "\n";
}

/// What a sequence of a condition must reach; half-resolution px and deg.
struct Bound {
  const char* name;
  double rms_px;
  double rms_deg;
};
void PrintTo(const Bound& bound, std::ostream* out) { *out << bound.name; }

void expectWithin(const SequenceRun& run, const Bound& bound)
{
  report(bound.name, run);
  const PoseScore score = run.score();
  EXPECT_LE(score.rms_px, bound.rms_px);
  EXPECT_LE(score.rms_deg, bound.rms_deg);
  EXPECT_EQ(score.tracked, 1.0);
  EXPECT_EQ(score.under_5_px, 1.0);
  EXPECT_EQ(score.tracked_while_hidden, 0.0);
  for (const int frames : score.frames_to_return) EXPECT_EQ(frames, 0);
}

// --- Rendered sequences -------------------------------------------------------------------------------------------

/// A condition whose events all happen in a short sequence.
simulation::Condition shortened(const std::string& name)
{
  simulation::Condition look = simulation::condition(name);
  look.microscope.laser.first_frame = 20;
  look.microscope.illumination.blackouts = std::min(look.microscope.illumination.blackouts, 2);
  look.microscope.illumination.blackout_longest_s = 0.8;
  look.motion.excursion_period_s = 4.0;
  look.motion.scale_period_s = 6.0;
  return look;
}

constexpr std::uint64_t kSeed = 5;

std::vector<simulation::RenderedFrame> rendered(const std::string& name, std::uint64_t seed)
{
  const simulation::Condition look = shortened(name);
  const simulation::SequenceOptions options{{400, 304}, 120, 30.0, seed};
  simulation::ProceduralFundusOptions procedural;
  procedural.um_per_px = umPerPixel(look.tissue, options);
  simulation::SequenceRenderer renderer(proceduralFundus(procedural, seed), look, options);
  std::vector<simulation::RenderedFrame> frames;
  while (auto frame = renderer.next()) frames.push_back(*frame);
  return frames;
}

TruthPose truthOf(const simulation::RenderedFrame& frame)
{
  const retina::Pose2& pose = frame.map_T_frame;
  return {frame.t_s, pose.x, pose.y, pose.theta * 180.0 / M_PI, pose.scale, frame.visible};
}

SequenceRun runOf(const std::vector<simulation::RenderedFrame>& frames)
{
  const auto method = baselines::makeMethod("eyeslam", {});
  SequenceRun run;
  for (const simulation::RenderedFrame& frame : frames) run.add(truthOf(frame), method->track(frame.image));
  return run;
}

class Rendered : public testing::TestWithParam<Bound> {};

TEST_P(Rendered, IsFollowed) { expectWithin(runOf(rendered(GetParam().name, kSeed)), GetParam()); }

// Measured over seeds 5 to 8, the worst plus 50 %; saccade and porcine, whose seeds differ by whole smears, seed 5 plus
// 50 %. A view 400 px wide is processed at 200 px, so a px is twice as much retina as in the sequences below.
INSTANTIATE_TEST_SUITE_P(Conditions, Rendered,
                         testing::Values(Bound{"human", 0.030, 0.019}, Bound{"paper", 0.015, 0.013},
                                         Bound{"porcine", 0.21, 0.095}, Bound{"saccade", 0.18, 0.040},
                                         Bound{"blackout", 0.026, 0.014}, Bound{"excursion", 0.057, 0.048},
                                         Bound{"deform", 0.39, 0.055}, Bound{"laser", 0.036, 0.016},
                                         Bound{"plain", 0.032, 0.023}));

TEST(RenderedSequence, StaysAccurateThroughLossyVideo)
{
  const auto frames = rendered("human", kSeed);
  const support::TemporaryFolder folder;
  const std::string path = folder.path("video.mp4");
  constexpr int kUsualQuality = 23;
  files::EncodedVideo video(path, path, frames[0].image.size(), 30.0, kUsualQuality);
  for (const simulation::RenderedFrame& frame : frames) video.add(frame.image);
  video.close();
  const auto source = files::openVideoSource(path, {});
  const auto method = baselines::makeMethod("eyeslam", {});
  SequenceRun run;
  for (files::VideoFrame frame; source->read(frame);) {
    run.add(truthOf(frames.at(static_cast<std::size_t>(frame.number))), method->track(frame.image));
  }
  ASSERT_EQ(run.truth.size(), frames.size());
  expectWithin(run, {"human through H.264", 0.063, 0.045});  // measured plus 50 %
}

// One sequence has few independent errors: 3 is perfect, a third and the double of it and more occur by chance.
TEST(RenderedSequence, HasErrorsAsLargeAsTheCovarianceSays)
{
  for (const char* name : {"human", "laser"}) {
    const double error = runOf(rendered(name, kSeed)).normalisedSquaredError();
    EXPECT_GT(error, 1.0) << name;
    EXPECT_LT(error, 8.0) << name;
  }
}

// --- Sequences with truth -----------------------------------------------------------------------------------------

std::string sharedFolder(const std::string& name)
{
  const char* shared = std::getenv("EYESLAM_SHARED");
  return (std::filesystem::path(shared ? shared : "../shared") / "sequences" / name).string();
}

SequenceRun runOf(const std::string& folder, const std::string& method_name)
{
  const files::TestSequence sequence = files::readTestSequence(folder);
  const auto source = files::openVideoSource(files::videoOfTestSequence(folder), {});
  const auto method = baselines::makeMethod(method_name, {});
  SequenceRun run;
  for (files::VideoFrame frame; source->read(frame);) {
    run.add(sequence.truth.poses.at(static_cast<std::size_t>(frame.number)), method->track(frame.image));
  }
  return run;
}

class Shared : public testing::TestWithParam<Bound> {};

TEST_P(Shared, IsWithinItsGate)
{
  const std::string folder = sharedFolder(GetParam().name);
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "NOT TESTED: there is no sequence " << folder;
  const SequenceRun run = runOf(folder, "eyeslam");
  expectWithin(run, GetParam());
  EXPECT_GT(run.normalisedSquaredError(), 1.5);  // issue 13; 3 is perfect
  EXPECT_LT(run.normalisedSquaredError(), 6.0);
}

// The gates of issue 13.
INSTANTIATE_TEST_SUITE_P(Gates, Shared,
                         testing::Values(Bound{"paper", 0.05, 0.010}, Bound{"human", 0.07, 0.015},
                                         Bound{"human2", 0.07, 0.015}, Bound{"laser", 0.13, 0.02},
                                         Bound{"plain", 0.12, 0.045}, Bound{"porcine", 0.27, 0.05},
                                         Bound{"saccade", 0.25, 0.06}, Bound{"blackout", 0.08, 0.02},
                                         Bound{"excursion", 0.13, 0.03}, Bound{"deform", 0.25, 0.10},
                                         Bound{"hd", 0.09, 0.008}));

class PaperRecipe : public testing::TestWithParam<const char*> {};

// No refinement and no mosaic: a map cell is 2 px wide. Issue 13: at most 1.5 px, or it would not be the paper's
// method.
TEST_P(PaperRecipe, IsTheMethodOfThePaper)
{
  const std::string folder = sharedFolder(GetParam());
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "NOT TESTED: there is no sequence " << folder;
  const SequenceRun run = runOf(folder, "paper");
  const PoseScore score = run.score();
  std::cout << "paper recipe on " << GetParam() << ": " << score.rms_px << " px, tracked " << score.tracked << "\n";
  EXPECT_LE(score.rms_px, 1.5);
}

INSTANTIATE_TEST_SUITE_P(PaperAndHuman, PaperRecipe, testing::Values("paper", "human", "human2"));

}  // namespace
}  // namespace eyeslam
