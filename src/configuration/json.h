// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "eyeslam/configuration/field.h"

namespace eyeslam::configuration {

/// All options as one flat object, keys as `--set` spells them.
inline nlohmann::ordered_json jsonOf(const std::vector<Field>& fields)
{
  auto json = nlohmann::ordered_json::object();
  for (const Field& field : fields) {
    std::visit([&](const auto* value) { json[field.key] = *value; }, field.value);
  }
  return json;
}

}  // namespace eyeslam::configuration
