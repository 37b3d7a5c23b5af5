// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "model/indent/rhombus_chain.h"
#include "model/units.h"
#include "tools/figures/figures.h"
#include "tools/printed/rhombus_paper.h"

namespace tact::tools::figures {

using namespace model;

Rows rhombus_units() {
  // RC-13: the printed liver in N/mm. A tenth of its limit.
  constexpr double kForce_N = 1.5;
  const auto chain = indent::make_rhombus_chain({.rod_length_m = 10_mm,
                                                 .initial_angle_rad = 30_deg,
                                                 .normal_stiffness_N_per_m = 1500.0,
                                                 .tangential_stiffness_N_per_m = 1800.0,
                                                 .growth = 2.0,
                                                 .units = 10});
  const auto as_printed_mm = [](const indent::RhombusUnit& unit, double force_N) {
    const auto at = printed::paper_inverse(unit, force_N);
    return at.status == law::LawStatus::kOk ? 1e3 * at.unit.shortening_m
                                            : std::numeric_limits<double>::quiet_NaN();
  };
  const auto pressed = chain->at_force(kForce_N), pulled = chain->at_force(-kForce_N);
  Rows rows;
  for (std::size_t i = 0; i < chain->unit_count(); ++i) {
    const auto& unit = chain->unit(i);
    rows.push_back({{"unit", i + 1},
                    {"pressed_mm", 1e3 * pressed.shortening_m[i]},
                    {"pulled_mm", 1e3 * pulled.shortening_m[i]},
                    {"printed_pressed_mm", -as_printed_mm(unit, -kForce_N)},
                    {"printed_pulled_mm", -as_printed_mm(unit, kForce_N)}});
  }
  return rows;
}

}  // namespace tact::tools::figures
