// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "model/hand_path.h"
#include "model/indent/hex_sheet.h"
#include "model/units.h"
#include "tools/figures/figures.h"
#include "tools/printed/hex_paper.h"

namespace tact::tools::figures {
namespace {

using namespace model;
using indent::HexWeight;

constexpr double kPitch_m = 2_mm;       // printed
constexpr double kBody_N_per_m = 50.0;  // printed
constexpr std::size_t kRings = 25;      // printed
constexpr double kDepth_m = 5_mm;       // ours: none is printed
constexpr double kDeepest_m = 7_mm;     // ours
constexpr std::size_t kMaxRings = 31;   // that the energy form has

/// The energy form with the printed numbers; K_T and T0 are ours (HX-28).
double energy_N(std::size_t rings, double depth_m) {
  const auto sheet = indent::make_hex_sheet({.ring_pitch_m = kPitch_m,
                                             .contact_stiffness_N_per_m = kBody_N_per_m,
                                             .body_stiffness_N_per_m = kBody_N_per_m,
                                             .surface_stiffness_N_per_m = 200.0,
                                             .tension_N = 0.15,
                                             .rings = rings,
                                             .weight = HexWeight::kNode,
                                             .working_depth_m = 10_mm});
  return sheet->respond(depth_m).force_N;
}

double printed_N(std::size_t rings, double depth_m, HexWeight weight) {
  return printed::paper_force_N(printed::paper_shape_at_depth(kPitch_m, rings, depth_m),
                                kBody_N_per_m, weight);
}

}  // namespace

Rows skin_rings() {
  Rows rows;
  for (std::size_t m = 1; m <= kMaxRings; ++m)
    rows.push_back({{"rings", m},
                    {"printed_per_ring_N", printed_N(m, kDepth_m, HexWeight::kRing)},
                    {"printed_per_node_N", printed_N(m, kDepth_m, HexWeight::kNode)},
                    {"energy_N", energy_N(m, kDepth_m)}});
  return rows;
}

Rows near_field_indentation() {
  // The strains are ours: the copy lists none.
  constexpr std::pair<const char*, double> kStrains[] = {
      {"strain_005_mm", 0.05}, {"strain_01_mm", 0.1}, {"strain_02_mm", 0.2}, {"strain_04_mm", 0.4}};
  Rows rows(kRings + 1);
  for (std::size_t i = 0; i <= kRings; ++i) rows[i].emplace_back("ring", i);
  for (const auto& [column, strain] : kStrains) {
    const auto shape = printed::paper_shape_at_strain(kPitch_m, kRings, strain);
    for (std::size_t i = 0; i <= kRings; ++i) rows[i].emplace_back(column, 1e3 * shape.ring_m[i]);
  }
  return rows;
}

Rows skin_press() {
  const std::vector<HandWaypoint> press{{.time_s = 0.0, .position_m = {}},
                                        {.time_s = 1.0, .position_m = {kDeepest_m, 0.0, 0.0}},
                                        {.time_s = 2.0, .position_m = {kDeepest_m, 0.0, 0.0}},
                                        {.time_s = 3.0, .position_m = {}}};
  Rows rows;
  for (int i = 0; i <= 60; ++i) {
    const double time_s = 0.05 * i;
    const double depth_m = hand_target(press, false, time_s).position_m.x;
    rows.push_back({{"time_s", time_s},
                    {"depth_mm", 1e3 * depth_m},
                    {"printed_N", printed_N(kRings, depth_m, HexWeight::kRing)},
                    {"energy_N", energy_N(kRings, depth_m)}});
  }
  return rows;
}

}  // namespace tact::tools::figures
