// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eyeslam::trials {

/// How an aid (contracts, section 7) is called and coloured in every figure of a report. Colours: Okabe and Ito 2008,
/// which the colour-blind tell apart, and which differ in print without colour.
struct AidStyle {
  std::string name;
  std::string colour;
  int rank = 0;  ///< order in figures: the unaided first, the strongest last
};

/// Of an aid that is not known: its own word, grey, last.
AidStyle styleOf(const std::string& aid);

/// Whether it is what aids are compared with: none, manual.
bool isUnaided(const std::string& aid);

}  // namespace eyeslam::trials
