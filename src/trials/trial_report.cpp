// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_report.h"

#include <fmt/format.h>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/burn_figure.h"
#include "eyeslam/trials/error_charts.h"
#include "eyeslam/trials/report_notes.h"
#include "eyeslam/trials/report_page.h"
#include "eyeslam/trials/report_sections.h"
#include "eyeslam/trials/report_tables.h"
#include "eyeslam/trials/report_warnings.h"

namespace eyeslam::trials {

namespace {

std::string conditionsOf(const TrialRecord& record)
{
  const TrialScore& score = record.score;
  // A computer that measures its cycles works in real time, with the latency that it has.
  const std::string latency =
      record.computation_s.empty() ? fmt::format("{:.4g} ms", score.latency_ms) : "in real time";
  return fmt::format("aid {} \u00b7 motion {} \u00b7 {} \u00b7 retina {} \u00b7 camera {:.4g} Hz, {} \u00b7 {:.1f} s",
                     score.aid, score.motion, score.condition, score.retina, score.camera_hz, latency,
                     score.duration_s);
}

}  // namespace

std::string trialReport(const TrialRecord& record)
{
  ReportPage page(nameOf(record), conditionsOf(record));
  page.warnings(warningsOf(record));
  page.headlines(headlinesOf(record));
  page.note(truthNote());
  page.note(operatorNote(record));
  page.section(record.task == "laser" ? "Burns" : "Way of the tip");
  addPictures({&record}, "retina", page);
  if (record.task == "laser") {
    page.table(targetTable(record), "What became of the targets.");
    page.figure(
        placementFigure({{&record}}),
        "Each burn as seen from its target. Black ring: 60 \u00b5m, and farther counts as far; grey: 30, 120, 240 "
        "\u00b5m.");
  }
  page.figure(errorDistribution({{record.score.aid, {&record}}}), "Distribution of the errors.");
  page.section("Timing");
  addLatencies({&record}, page);
  page.section("What happened");
  page.table(eventTable(record.events), "States of the servo and other events; time since the part that counts began.");
  page.section("Figures and configuration");
  page.foldedTable("Every pulse", pulseTable(record.pulses));
  page.foldedTable("Every score", scoreTable(record.score));
  page.folded("Scenario and every option, as YAML", record.configuration);
  page.paragraph(fmt::format("Version {}, configuration {}.", record.score.version, record.score.config_hash));
  return page.html();
}

}  // namespace eyeslam::trials
