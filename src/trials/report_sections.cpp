// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_sections.h"

#include <fmt/format.h>

#include <algorithm>

#include "eyeslam/trials/burn_figure.h"
#include "eyeslam/trials/error_charts.h"
#include "eyeslam/trials/latency_charts.h"
#include "eyeslam/trials/report_notes.h"
#include "eyeslam/trials/trace_figure.h"

namespace eyeslam::trials {

namespace {

bool anyManual(const std::vector<const TrialRecord*>& trials)
{
  return std::any_of(trials.begin(), trials.end(), [](const TrialRecord* t) { return t->score.aid == "manual"; });
}

}  // namespace

void addPictures(const std::vector<const TrialRecord*>& trials, const std::string& name, ReportPage& page)
{
  const std::uint64_t seed = trials.front()->score.seed;
  if (trials.front()->task == "laser") {
    page.figure(
        burnFigure(trials, vesselMarginOf(*trials.back()), name),
        fmt::format("Burns over the true retina, seed {}: rings are targets, discs the burns where they truly went, in "
                    "true size. Outlined in red: true vessels.{}",
                    seed, anyManual(trials) ? " Manual: a model fitted to nothing." : ""));
    return;
  }
  const bool height = trials.front()->task == "standoff";
  page.figure(traceFigure(trials, name),
              fmt::format("Way of the tip over the true retina, seed {}. {}", seed,
                          height ? "Seen from above: the error is that of the height, in the next figure."
                                 : "The rectangle in the overview is the close-up."));
  page.figure(
      errorOverTime(trials),
      fmt::format("Error of the tip over time, seed {}: from the least to the greatest of each column, and its RMS "
                  "over 0.5 s (line). Dashed red: events that are warned of.{}",
                  seed,
                  trials.size() > 1
                      ? " Eye and hand are the same with and without an aid, but an aided trial begins to "
                        "count later, for it is calibrated first."
                      : ""));
}

void addLatencies(const std::vector<const TrialRecord*>& trials, ReportPage& page)
{
  page.figure(latencyFigure(trials), "How old what the servo acts on is. Line: median; dashed: 95th percentile. " +
                                         latencyNote(*trials.front()));
}

}  // namespace eyeslam::trials
