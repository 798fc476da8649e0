// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/reason.h"

namespace eyeslam::retina {

std::string_view word(Reason reason)
{
  switch (reason) {
    case Reason::none:
      return "";
    case Reason::blackout:
      return "blackout";
    case Reason::wrong_size:
      return "wrong_size";
    case Reason::too_few_points:
      return "too_few_points";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::poor_match:
      return "poor_match";
    case Reason::blurred:
      return "blurred";
    case Reason::searching:
      return "searching";
  }
  return "unknown";
}

}  // namespace eyeslam::retina
