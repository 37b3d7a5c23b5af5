// SPDX-License-Identifier: Apache-2.0
// Lines in the parameters of the laws that no depth shows: where a law stops being one.
//
//     disc_cone     least slope of a disc over its stiffness, by eta: 1 - eta^2/2, 0 at sqrt 2
//     disc_rate     layers that move, by the loop's rate: the modelled delay makes it fall
//     rhombus_snap  least slope of a unit over kN, by kT/kN at 60 deg: it snaps below 0
//     hex_ring, hex_node, hex_sheet   force at 5 mm, N, by the number of rings: the printed forms
//                                     have no limit, the energy form has
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/rhombus_unit.h"
#include "tools/printed/hex_paper.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

constexpr const char* kStudies[] = {"disc_cone", "disc_rate", "rhombus_snap",
                                    "hex_ring",  "hex_node",  "hex_sheet"};

std::size_t points(Extent extent) { return extent == Extent::kQuick ? 9 : 41; }

struct Point {
  double parameter = 0.0, measured = 0.0, theory = 0.0;
  const char* what = "";
};

// Chosen: so fine that the least sampled slope is the least one within the bounds of the findings.
constexpr int kSamples = 2000;

Point disc_cone(double t) {
  const double eta = 2.0 * t;
  const model::indent::Disc disc{
      .outer_diameter_m = 8e-3, .stiffness_N_per_m = 500.0, .travel_m = 0.9e-3, .cone_ratio = eta};
  double least = 1e9;
  for (int i = 0; i <= kSamples; ++i)
    least = std::min(least, model::indent::respond(disc, model::indent::DiscForm::kAlmenLaszlo,
                                                   disc.travel_m * i / kSamples)
                                .stiffness_N_per_m);
  const bool accepted = model::indent::is_monotone(disc, model::indent::DiscForm::kAlmenLaszlo);
  return {eta, least / disc.stiffness_N_per_m, 1.0 - 0.5 * eta * eta,
          accepted ? "grows to flat" : "snaps through: refused when the scene is read"};
}

Point disc_rate(double t) {
  const double rate_Hz = 250.0 * std::pow(2.0, 5.0 * t);
  const model::indent::LayerDelays delays{
      .first_delay_s = 2e-5, .delay_ratio = 1.1, .refresh_rate_Hz = rate_Hz, .layers = 64};
  // DS-8: layers of which T_i < 1/rate.
  const auto layers = static_cast<double>(model::indent::layer_budget(delays));
  // T_i = t1 (q^i - 1)/(q - 1) < T
  const double theory = std::log(1.0 + 0.1 / (rate_Hz * 2e-5)) / std::log(1.1);
  return {rate_Hz, layers, std::ceil(theory) - 1.0,
          "the same tissue ends earlier on a faster loop"};
}

Point rhombus_snap(double t) {
  const double ratio = 4.0 * t, angle_rad = std::numbers::pi / 3.0;
  const model::indent::RhombusUnit unit{.rod_length_m = 0.010,
                                        .initial_angle_rad = angle_rad,
                                        .normal_stiffness_N_per_m = 1000.0,
                                        .tangential_stiffness_N_per_m = 1000.0 * ratio};
  const double flat_m = 2.0 * unit.rod_length_m * std::sin(angle_rad);
  double least = 1e9;
  for (int i = 0; i < kSamples; ++i)
    least = std::min(least, model::indent::respond(unit, flat_m * i / kSamples).stiffness_N_per_m);
  // RC-5 at flat: kN - kT (1 - cos theta0)
  return {ratio, least / 1000.0, 1.0 - ratio * (1.0 - std::cos(angle_rad)),
          model::indent::press_limit(unit).kind == model::indent::UnitLimit::kSnap
              ? "snaps before it is flat: saturates there"
              : "ends flat"};
}

Point hex(double t, int kind) {
  constexpr double kDepth_m = 5e-3, kPitch_m = 2e-3, kBody_N_per_m = 50.0;
  // The energy form has an upper number of rings of its own (HX-27).
  const auto most =
      static_cast<double>(kind == 2 ? model::indent::kMaxHexRings : printed::kMaxPaperRings);
  const auto rings = static_cast<std::size_t>(std::lround(3.0 + (most - 3.0) * t));
  Point point{.parameter = static_cast<double>(rings)};
  if (kind == 2) {
    const auto sheet = model::indent::make_hex_sheet({.ring_pitch_m = kPitch_m,
                                                      .contact_stiffness_N_per_m = kBody_N_per_m,
                                                      .body_stiffness_N_per_m = kBody_N_per_m,
                                                      .surface_stiffness_N_per_m = 200.0,
                                                      .tension_N = 0.15,
                                                      .rings = rings,
                                                      .weight = model::indent::HexWeight::kNode,
                                                      .working_depth_m = 8e-3});
    point.measured = sheet ? sheet->respond(kDepth_m).force_N : std::nan("");
    point.theory = 2.5806;  // HX-28
    point.what = "has a limit";
    return point;
  }
  const auto weight = kind == 0 ? model::indent::HexWeight::kRing : model::indent::HexWeight::kNode;
  point.measured = printed::paper_force_N(printed::paper_shape_at_depth(kPitch_m, rings, kDepth_m),
                                          kBody_N_per_m, weight);
  // grows like m or like m^2 from HX-12 at m = 25
  const double share = static_cast<double>(rings) / 25.0;
  point.theory = kind == 0 ? 2.323 * share : 98.75 * share * share;
  point.what = "grows with every ring: no limit";
  return point;
}

report::Row run(std::size_t job, Extent extent) {
  const std::size_t study = job / points(extent);
  const double t =
      static_cast<double>(job % points(extent)) / static_cast<double>(points(extent) - 1);
  const Point p = study == 0   ? disc_cone(t)
                  : study == 1 ? disc_rate(t)
                  : study == 2 ? rhombus_snap(t)
                               : hex(t, static_cast<int>(study) - 3);
  return {{"study", kStudies[study]},
          {"parameter", p.parameter},
          {"measured", p.measured},
          {"theory", p.theory},
          {"what_happens", p.what}};
}

}  // namespace

Map law_line_map() {
  return {.letter = 'b',
          .name = "law_lines",
          .purpose = "parameters beyond which a law snaps, ends early or has no limit",
          .jobs = [](Extent extent) { return std::size(kStudies) * points(extent); },
          .run = run};
}

}  // namespace tact::tools::stability
