// SPDX-License-Identifier: Apache-2.0
// unit_name.h - the unit at the end of a name, of a key of a scene or a field of telemetry.
#pragma once

#include <string_view>

namespace tact::model::io {

struct UnitName {
  std::string_view suffix, unit;  // "_N_per_m", "N/m"
};

/// Null for a name without one.
const UnitName* find_unit(std::string_view name);

/// For people: "N/m" of tear_N_per_m, "" of a name without one.
std::string_view unit_of(std::string_view name);

}  // namespace tact::model::io
