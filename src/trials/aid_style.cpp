// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/aid_style.h"

#include <map>

namespace eyeslam::trials {

AidStyle styleOf(const std::string& aid)
{
  static const std::map<std::string, AidStyle> kStyles{
      {"none", {"no aid", "#d55e00", 0}},          {"manual", {"manual (model)", "#d55e00", 1}},
      {"filter", {"tremor filter", "#cc79a7", 2}}, {"scaling", {"motion scaling", "#e69f00", 3}},
      {"soft", {"soft fixture", "#009e73", 4}},    {"hard", {"hard fixture", "#0072b2", 5}},
      {"automated", {"automated", "#0072b2", 6}},
  };
  const auto style = kStyles.find(aid);
  return style != kStyles.end() ? style->second : AidStyle{aid, "#666666", 7};
}

bool isUnaided(const std::string& aid) { return aid == "none" || aid == "manual"; }

}  // namespace eyeslam::trials
