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
    case Reason::near_vessel:
      return "near_vessel";
    case Reason::near_fovea:
      return "near_fovea";
    case Reason::near_disc:
      return "near_disc";
    case Reason::in_keep_out:
      return "in_keep_out";
    case Reason::not_seen:
      return "not_seen";
    case Reason::outside_map:
      return "outside_map";
    case Reason::crowded:
      return "crowded";
  }
  return "unknown";
}

}  // namespace eyeslam::retina
