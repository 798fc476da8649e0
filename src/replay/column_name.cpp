// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/column_name.h"

namespace eyeslam::replay {

std::string columnName(const FieldName& name)
{
  std::string column(name.name);
  const auto append = [&column](std::string_view part) {
    if (!part.empty()) (column += '_') += part;
  };
  const bool square = !name.unit.empty() && name.unit == name.second_unit;
  for (const std::string_view part : {name.part, name.second_part, name.unit}) append(part);
  if (square && name.unit.find('_') == std::string_view::npos) {
    column += '2';
  } else {
    append(name.second_unit);
  }
  return column;
}

}  // namespace eyeslam::replay
