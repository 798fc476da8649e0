// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/replay/field_walk.h"

namespace eyeslam::replay {

/// A field's name as a column of a table has it: "tip_position_x_m", "covariance_x_x_px2".
std::string columnName(const FieldName& name);

}  // namespace eyeslam::replay
