// SPDX-License-Identifier: Apache-2.0
// The published cases of the hexagonal surface: in its energy form, as printed, and as a membrane.

#include "model/indent/hex_sheet.h"
#include "model/indent/membrane.h"
#include "tools/printed/hex_paper.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace hex_cases {

using model::indent::HexWeight;
using model::law::LawStatus;
using nlohmann::json;

json refused() {
  return {{"status", "INVALID_ARGUMENT"}, {"F", 0.0}, {"F_ring", 0.0}, {"F_node", 0.0}};
}

/// The cases are of a surface that cannot be held: no force at d <= 0.
json no_contact() {
  return {{"status", "NO_CONTACT"}, {"F", 0.0}, {"F_ring", 0.0}, {"F_node", 0.0}, {"eps1", 0.0}};
}

json energy_results(const json& one_case) {
  const json& p = one_case.at("params");
  const double depth_m = number(one_case.at("inputs").at("depth"));
  const auto sheet = model::indent::make_hex_sheet({
      .ring_pitch_m = number(p.at("r")),
      .contact_stiffness_N_per_m = number(p.at("KN0")),
      .body_stiffness_N_per_m = number(p.at("KN")),
      .surface_stiffness_N_per_m = number(p.at("KT")),
      .tension_N = number(p.at("T0")),
      .rings = p.at("m").get<std::size_t>(),
      .weight = p.at("weight") == "NODE" ? HexWeight::kNode : HexWeight::kRing,
      // A sheet needs one above zero; the cases at d <= 0 never reach it.
      .working_depth_m = depth_m > 0.0 ? depth_m : 1.0,
  });
  if (!sheet) return refused();
  const model::indent::HexSheetState at = sheet->at_depth(depth_m);
  // Before the depth: a bad number is refused even where there is no force.
  if (at.status == LawStatus::kInvalid) return refused();
  if (depth_m <= 0.0) return no_contact();
  // HX-6: rings 0 .. m.
  std::vector<double> ring_m(sheet->parameters().rings + 1);
  sheet->profile(depth_m, ring_m);
  return {{"status", "OK"},
          {"F", at.force_N},
          {"U", at.energy_J},
          {"profile", ring_m},
          {"boundary_reaction", at.boundary_force_N}};
}

json boundary_results(const json& inputs) {
  const printed::PaperRings rings =
      // HX-13: rings from the slope of the rim.
      printed::paper_rings(number(inputs.at("eps1")), number(inputs.at("b")));
  if (rings.status == LawStatus::kInvalid) return refused();
  const bool saturated = rings.status == LawStatus::kSaturated;
  return {{"status", saturated ? "SATURATED" : "OK"}, {"m_real", rings.exact}, {"m", rings.rings}};
}

json paper_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  if (inputs.at("mode") == "BOUNDARY") return boundary_results(inputs);
  const double pitch_m = number(p.at("r")), stiffness_N_per_m = number(p.at("KN"));
  const auto rings = p.at("m").get<std::size_t>();
  const bool by_strain = inputs.at("mode") == "EPS1";
  const double input = number(inputs.at(by_strain ? "eps1" : "depth"));
  // paper_force_N() does not check it.
  if (!(stiffness_N_per_m > 0.0)) return refused();
  if (!by_strain && input <= 0.0) return no_contact();
  const printed::PaperShape at = by_strain ? printed::paper_shape_at_strain(pitch_m, rings, input)
                                           : printed::paper_shape_at_depth(pitch_m, rings, input);
  if (at.rings == 0) return refused();
  json z = json::array(), l = json::array(), strain = json::array();
  for (std::size_t i = 0; i < at.rings; ++i) {
    l.push_back(at.drop_m[i]);
    strain.push_back(at.strain[i]);
  }
  for (std::size_t j = 0; j <= at.rings; ++j) z.push_back(at.ring_m[j]);
  return {{"status", "OK"},
          {"depth", at.ring_m[0]},
          {"eps1", at.first_strain},
          {"eps", strain},
          {"l", l},
          {"Z", z},
          {"lm_over_r", at.boundary_slope},
          // HX-12 with both weights (X17).
          {"F_ring", printed::paper_force_N(at, stiffness_N_per_m, HexWeight::kRing)},
          {"F_node", printed::paper_force_N(at, stiffness_N_per_m, HexWeight::kNode)}};
}

json membrane_results(const json& one_case) {
  const json& p = one_case.at("params");
  model::indent::MembraneParameters parameters;
  parameters.tension_N_per_m = number(p.at("tension"));
  parameters.foundation_Pa_per_m = number(p.at("foundation"));
  parameters.softening_depth_m = number(p.at("softening_depth"));
  parameters.softening_exponent = number(p.at("softening_exponent"));
  parameters.working_depth_m = number(p.at("working_depth"));
  const auto membrane = model::indent::make_membrane(parameters, number(p.at("tip_radius")));
  if (!membrane) return {{"status", "INVALID_ARGUMENT"}};
  const auto at = membrane->respond(number(one_case.at("inputs").at("depth")));
  return {{"F", at.force_N}, {"status", word(kLawStatus, at.status)}};
}

constexpr Verifier kVerifiers[] = {
    {"hex_surface_energy", verify_cases<energy_results>},
    {"hex_surface_paper", verify_cases<paper_results>},
    {"membrane", verify_cases<membrane_results>},
};

}  // namespace hex_cases

std::span<const Verifier> hex_verifiers() { return hex_cases::kVerifiers; }

}  // namespace tact::tools::verify
