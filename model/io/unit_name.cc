// SPDX-License-Identifier: Apache-2.0
#include "model/io/unit_name.h"

#include <array>

namespace tact::model::io {
namespace {

// Longest first, so that _N_per_m is not read as _m.
constexpr std::array kUnits{
    UnitName{"_Nms_per_rad", "N m s/rad"},
    UnitName{"_words_per_Nm", "word/(N m)"},
    UnitName{"_Ns_per_m", "N s/m"},
    UnitName{"_turns_per_s", "turn/s"},
    UnitName{"_N_per_m", "N/m"},
    UnitName{"_N_per_s", "N/s"},
    UnitName{"_s_per_m", "s/m"},
    UnitName{"_turns", "turn"},
    UnitName{"_words", "word"},
    UnitName{"_kgm2", "kg m^2"},
    UnitName{"_rad", "rad"},
    UnitName{"_deg", "deg"},
    UnitName{"_Nm", "N m"},
    UnitName{"_kg", "kg"},
    UnitName{"_Hz", "Hz"},
    UnitName{"_Pa", "Pa"},
    UnitName{"_m2", "m^2"},
    UnitName{"_m", "m"},
    UnitName{"_s", "s"},
    UnitName{"_ns", "ns"},
    UnitName{"_us", "us"},
    UnitName{"_um", "um"},
    UnitName{"_px", "px"},
    UnitName{"_N", "N"},
    UnitName{"_A", "A"},
    UnitName{"_C", "degC"},
    UnitName{"_J", "J"},
    UnitName{"_W", "W"},
    UnitName{"_mps", "m/s"},
    UnitName{"_radps", "rad/s"},
};

}  // namespace

const UnitName* find_unit(std::string_view name) {
  for (const UnitName& unit : kUnits)
    if (name.ends_with(unit.suffix)) return &unit;
  return nullptr;
}

std::string_view unit_of(std::string_view name) {
  const UnitName* unit = find_unit(name);
  return unit ? unit->unit : std::string_view{};
}

}  // namespace tact::model::io
