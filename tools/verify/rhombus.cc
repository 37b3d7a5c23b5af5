// SPDX-License-Identifier: Apache-2.0
// The published cases of the rhombus law: one unit, the chain, and the law as printed.
#include <cmath>

#include "model/indent/rhombus_chain.h"
#include "tools/printed/rhombus_paper.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace rhombus_cases {

using model::indent::RhombusUnit;
using model::law::LawStatus;
using nlohmann::json;

constexpr const char* kUnitLimit[] = {"FLAT", "SNAP"};

RhombusUnit unit_of(const json& p, const char* tangential) {
  return {.rod_length_m = number(p.at("a")),
          .initial_angle_rad = number(p.at("theta0")),
          .normal_stiffness_N_per_m = number(p.at("kN")),
          .tangential_stiffness_N_per_m = number(p.at(tangential))};
}

json unit_results(const json& one_case) {
  const RhombusUnit unit = unit_of(one_case.at("params"), "kT");
  const model::indent::UnitResponse r =
      model::indent::respond(unit, number(one_case.at("inputs").at("x")));
  json got{{"status", word(kLawStatus, r.status)}, {"f", r.force_N}};
  // The file expects nothing more of a unit that is none.
  if (r.status == LawStatus::kInvalid) return got;
  const model::indent::UnitPressLimit limit = model::indent::press_limit(unit);
  got.update({{"theta", r.angle_rad},
              {"dtheta", r.angle_change_rad},
              {"lam", r.lambda},
              {"y", r.widening_m},
              {"k_tan", r.stiffness_N_per_m},
              {"U", r.energy_J},
              {"x_lim", limit.shortening_m},
              {"f_lim", limit.force_N},
              {"lim_kind", word(kUnitLimit, limit.kind)}});
  return got;
}

model::indent::RhombusChainParameters chain_parameters(const json& p) {
  const RhombusUnit first = unit_of(p, "kT1");
  const auto units = p.at("N").get<long>();
  return {.rod_length_m = first.rod_length_m,
          .initial_angle_rad = first.initial_angle_rad,
          .normal_stiffness_N_per_m = first.normal_stiffness_N_per_m,
          .tangential_stiffness_N_per_m = first.tangential_stiffness_N_per_m,
          .growth = number(p.at("beta")),
          // Below zero it must not wrap to a huge number; 0 is refused, and is a case.
          .units = units > 0 ? static_cast<std::size_t>(units) : 0};
}

/// The display rule of the source: how far the chain "moves" by its own cut at lambda = 0.05.
void add_lambda_rule(const model::indent::RhombusChain& chain, const model::indent::ChainState& at,
                     json& got) {
  json lambdas = json::array(), shortenings = json::array();
  int leading = 0;
  double depth_m = 0.0;
  for (std::size_t i = 0; i < chain.unit_count(); ++i) {
    const double x = at.shortening_m[i];
    const double lambda = model::indent::respond(chain.unit(i), x).lambda;
    shortenings.push_back(x);
    lambdas.push_back(lambda);
    // Only an unbroken row from the contact on counts.
    if (leading == static_cast<int>(i) && lambda >= 0.05) ++leading, depth_m += x;
  }
  got.update(
      {{"x", shortenings}, {"lam", lambdas}, {"N_lambda", leading}, {"depth_lambda", depth_m}});
}

json chain_results(const json& one_case) {
  const json& inputs = one_case.at("inputs");
  const auto chain = model::indent::make_rhombus_chain(chain_parameters(one_case.at("params")));
  if (!chain) return {{"status", word(kLawStatus, LawStatus::kInvalid)}, {"F", 0.0}};
  const bool force_in = inputs.at("mode") == "FORCE";
  const model::indent::ChainState at = force_in ? chain->at_force(number(inputs.at("F")))
                                                : chain->at_depth(number(inputs.at("depth")));
  json got{{"status", word(kLawStatus, at.status)}, {"F", at.force_N}};
  if (at.status == LawStatus::kInvalid) return got;
  std::vector<double> ring_m(chain->unit_count() + 1);
  chain->profile(at.depth_m, ring_m);
  got.update({{"depth", at.depth_m},
              {"U", at.energy_J},
              {"k_tan", at.stiffness_N_per_m},
              {"profile", ring_m},
              {"F_lim", chain->force_limit_N()},
              {"d_lim", chain->range().press_m},
              // The file counts units from 1, as RC-8 does.
              {"lim_unit", chain->weakest_unit() + 1},
              {"lim_kind", word(kUnitLimit, chain->limit_kind())},
              // RC-12: U / depth, as the source prints it.
              {"F_eq12", at.depth_m != 0.0 ? at.energy_J / at.depth_m : 0.0}});
  add_lambda_rule(*chain, at, got);
  return got;
}

json paper_forward_results(const json& one_case) {
  const json& p = one_case.at("params");
  json dl = json::array(), dv = json::array(), d = json::array(), f3 = json::array(),
       f_energy = json::array();
  double depth_m = 0.0, energy_J = 0.0;
  int singular_unit = 0, i = 0;
  for (const json& angle : one_case.at("inputs").at("dtheta")) {
    RhombusUnit unit = unit_of(p, "kT1");
    unit.tangential_stiffness_N_per_m *= std::exp(i / number(p.at("beta")));  // (11)
    const printed::PaperUnit at = printed::paper_forward(unit, number(angle));
    // X2: the first unit at which D is zero.
    if (printed::paper_divides_by_zero(unit, at) && singular_unit == 0) singular_unit = i + 1;
    dl.push_back(at.shortening_m);
    dv.push_back(at.widening_m);
    d.push_back(at.stiffness_N_per_m);
    f3.push_back(at.force_N);
    // A press is below zero in the paper and above it in the energy form.
    f_energy.push_back(-model::indent::respond(unit, -at.shortening_m).force_N);
    depth_m += at.shortening_m;
    energy_J += at.energy_J;
    ++i;
  }
  return {{"status", singular_unit == 0 ? "OK" : "SINGULAR"},
          {"singular_unit", singular_unit},
          {"dl", dl},
          {"dv", dv},
          {"D", d},
          {"F_eq3", f3},
          {"F_energy", f_energy},
          {"dL", depth_m},
          {"U", energy_J},
          {"F_eq12", depth_m != 0.0 ? energy_J / depth_m : 0.0}};
}

json paper_results(const json& one_case) {
  if (one_case.at("inputs").at("mode") == "FORWARD") return paper_forward_results(one_case);
  const RhombusUnit unit = unit_of(one_case.at("params"), "kT");
  const double force_N = number(one_case.at("inputs").at("F"));
  const printed::PaperInverse at = printed::paper_inverse(unit, force_N);
  return {{"status", word(kLawStatus, at.status)},
          {"D0", printed::paper_initial_stiffness_N_per_m(unit)},
          {"dtheta", at.angle_change_rad},
          {"dl", at.unit.shortening_m},
          {"dv", at.unit.widening_m},
          {"lam", at.lambda},
          {force_N > 0.0 ? "F_max" : "F_min", at.limit_N}};
}

constexpr Verifier kVerifiers[] = {
    {"rhombus_unit_eval", verify_cases<unit_results>},
    {"rhombus_chain_energy", verify_cases<chain_results>},
    {"rhombus_paper_literal", verify_cases<paper_results>},
};

}  // namespace rhombus_cases

std::span<const Verifier> rhombus_verifiers() { return rhombus_cases::kVerifiers; }

}  // namespace tact::tools::verify
