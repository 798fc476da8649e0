// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/simulation/fundus.h"
#include "link/program_link.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-sim`: a sequence on disk (--out), or a bench behind the messages (--live).
struct SimArguments {
  // Both
  std::string condition = "human";
  std::string motion;
  std::string retina = "procedural";
  std::string vessels;
  double retina_um_per_px = 4.0;
  std::string size;  ///< empty: the condition's
  std::uint64_t seed = 1;
  bool quiet = false;

  // A sequence
  std::string out;
  int frames = 300;
  bool lossless = false;

  // Live
  bool live = false;
  LinkArguments link;
  std::string shm = "eye";
  double fps = 30.0;
  double duration_s = 0.0;  ///< 0: until Ctrl-C
  std::string task = "hold";
  std::vector<std::string> faults;  ///< "WHAT@SECONDS"
  bool foot_switch = false;
};

void addOptions(CLI::App& app, SimArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const SimArguments& arguments);

/// The retina, drawn or from a photograph. @throws UsageError, files::FileError
simulation::Fundus fundusOf(const SimArguments& arguments, double um_per_px);

}  // namespace eyeslam::apps
