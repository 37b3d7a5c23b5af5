// SPDX-License-Identifier: Apache-2.0
#include <array>

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

Figure skin_rings() {
  std::vector<report::Row> rows;
  for (std::size_t m = 1; m <= kMaxRings; ++m)
    rows.push_back({static_cast<double>(m), printed_N(m, kDepth_m, HexWeight::kRing),
                    printed_N(m, kDepth_m, HexWeight::kNode), energy_N(m, kDepth_m)});
  return {
      .name = "skin_rings",
      .of = "[3] fig. 5",
      .shows = "force over the number of rings: as printed it has no limit",
      .numbers = {},
      .curves = curves_of("skin_rings",
                          {"rings", "printed_per_ring_N", "printed_per_node_N", "energy_N"}, rows),
      .picture = {.name = "skin_rings", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'skin_rings.csv'
set title "[3] fig. 5: force at 5 mm over the number of rings (50 N/m, 2 mm)\n\
no number of the curve is in the copy: all lines by tact, the depth is ours"
set xlabel "rings m"
set ylabel "force, N"
set logscale y
set key top left
plot 3.3 lc rgb '#999999' dt 3 title 'most that its device gives', \
     f using 2:3 with linespoints lt 2 pt 7 title 'as printed, a body spring per ring', \
     f using 2:4 with linespoints lt 5 pt 7 title 'as printed, per node', \
     f using 2:5 with linespoints lt 1 lw 2 pt 7 title 'energy form'
)gp"}};
}

Figure near_field_indentation() {
  constexpr std::array kStrain{0.05, 0.1, 0.2, 0.4};  // ours: the copy lists none
  std::array<printed::PaperShape, kStrain.size()> shape;
  for (std::size_t k = 0; k < kStrain.size(); ++k)
    shape[k] = printed::paper_shape_at_strain(kPitch_m, kRings, kStrain[k]);
  std::vector<report::Row> rows;
  for (std::size_t i = 0; i <= kRings; ++i) {
    report::Row row{static_cast<double>(i)};
    for (const auto& at : shape) row.emplace_back(1e3 * at.ring_m[i]);
    rows.push_back(std::move(row));
  }
  return {.name = "skin_dent",
          .of = "[3] fig. 6",
          .shows = "dent of 25 rings for several strains of the first spring",
          .numbers = {},
          .curves = curves_of(
              "skin_dent",
              {"ring", "strain_005_mm", "strain_01_mm", "strain_02_mm", "strain_04_mm"}, rows),
          .picture = {.name = "skin_dent", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'skin_dent.csv'
set title "[3] fig. 6: dent of 25 rings as printed, by the strain of the first spring\n\
no number of the curves is in the copy: all lines by tact, the strains are ours"
set xlabel "ring"
set ylabel "displacement, mm"
set yrange [] reverse
set key bottom right
plot f using 2:3 with linespoints lt 1 title '0.05', \
     f using 2:4 with linespoints lt 2 title '0.1', \
     f using 2:5 with linespoints lt 3 title '0.2', \
     f using 2:6 with linespoints lt 4 title '0.4'
)gp"}};
}

Figure skin_press() {
  const std::vector<HandWaypoint> press{{.time_s = 0.0, .position_m = {}},
                                        {.time_s = 1.0, .position_m = {kDeepest_m, 0.0, 0.0}},
                                        {.time_s = 2.0, .position_m = {kDeepest_m, 0.0, 0.0}},
                                        {.time_s = 3.0, .position_m = {}}};
  std::vector<report::Row> rows;
  for (int i = 0; i <= 60; ++i) {
    const double time_s = 0.05 * i;
    const double depth_m = hand_target(press, false, time_s).position_m.x;
    rows.push_back({time_s, 1e3 * depth_m, printed_N(kRings, depth_m, HexWeight::kRing),
                    energy_N(kRings, depth_m)});
  }
  return {.name = "skin_press",
          .of = "[3] fig. 8",
          .shows = "force of a press over time",
          .numbers = {},
          .curves = curves_of("skin_press", {"time_s", "depth_mm", "printed_N", "energy_N"}, rows),
          .picture = {.name = "skin_press", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'skin_press.csv'
set title "[3] fig. 8: force of a press of 7 mm and its release (50 N/m, 2 mm, 25 rings)\n\
no number of the curve is in the copy: all lines by tact, the stroke is ours"
set xlabel "time, s"
set ylabel "force, N"
set yrange [0:*]
plot 3.3 lc rgb '#999999' dt 3 title 'most that its device gives', \
     f using 2:4 with lines lt 2 lw 2 title 'as printed, a body spring per ring', \
     f using 2:5 with lines lt 1 lw 2 title 'energy form'
)gp"}};
}

}  // namespace tact::tools::figures
