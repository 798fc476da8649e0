// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_crew.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

#include "command_line/progress.h"
#include "trial/trial_job.h"

namespace eyeslam::apps {
namespace {

constexpr std::chrono::milliseconds kWatch{50};

std::size_t threadsFor(const TrialArguments& arguments, std::size_t trials)
{
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  if (arguments.real_time) return 1;
  const std::size_t wanted = arguments.jobs > 0 ? static_cast<std::size_t>(arguments.jobs) : cores;
  return std::min(wanted, trials);
}

}  // namespace

TrialCrew::TrialCrew(const TrialList& list, const TrialArguments& arguments, Interruption& interruption)
    : trials_(list.trials()),
      arguments_(arguments),
      interruption_(interruption),
      scenes_(list.trials()),
      records_(list.trials().size()),
      failures_(list.trials().size()),
      done_s_(list.trials().size())
{}

TrialOutcomes TrialCrew::run()
{
  workers_ = threadsFor(arguments_, trials_.size());
  std::vector<std::thread> threads;
  for (std::size_t i = workers_; i > 0; --i) threads.emplace_back([this] { work(); });
  watch();
  for (std::thread& thread : threads) thread.join();
  return outcomes();
}

void TrialCrew::work()
{
  omp_set_num_threads(1);  // of this thread's own parallel regions: a core runs a trial
  for (std::size_t index = next_++; index < trials_.size() && !stopped_; index = next_++) runOne(index);
  --workers_;
}

void TrialCrew::runOne(std::size_t index)
{
  const PlannedTrial& trial = trials_[index];
  try {
    const auto scene = scenes_.sceneOf(trial);
    TrialJob job(trial, arguments_, folders_);
    records_[index] = job.run(scene, [&](double time) {
      done_s_[index] = std::min(time, trial.longest_s);
      return !stopped_;
    });
  } catch (const std::exception& error) {
    failures_[index] = error.what();
  }
  done_s_[index] = trial.longest_s;
}

// The bar counts simulated seconds: trials are few and long.
void TrialCrew::watch()
{
  double total = 0.0;
  for (const PlannedTrial& trial : trials_) total += trial.longest_s;
  const Verbosity verbosity = arguments_.quiet ? Verbosity::quiet : Verbosity::normal;
  Progress progress(fmt::format("{} trial{}, simulated s", trials_.size(), trials_.size() == 1 ? "" : "s"),
                    static_cast<std::int64_t>(total), verbosity);
  while (workers_ > 0) {
    std::this_thread::sleep_for(kWatch);
    if (interruption_.requested()) stopped_ = true;
    double done = 0.0;
    for (const std::atomic<double>& of_trial : done_s_) done += of_trial;
    if (done >= 1.0) progress.show(static_cast<std::int64_t>(done));
  }
}

TrialOutcomes TrialCrew::outcomes()
{
  TrialOutcomes result;
  result.interrupted = stopped_;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    if (records_[i]) result.records.push_back(*std::move(records_[i]));
    if (!failures_[i].empty()) result.failures.push_back(fmt::format("{}: {}", nameOf(trials_[i]), failures_[i]));
  }
  return result;
}

}  // namespace eyeslam::apps
