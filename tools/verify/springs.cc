// SPDX-License-Identifier: Apache-2.0
// The published cases of the integrators: one oscillator, its stability, the claims, and a network.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

#include "model/springs/integrator_stability.h"
#include "model/springs/integrators.h"
#include "model/springs/spring_network.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace springs_cases {

using model::Vec3;
using model::springs::Integrator;
using model::springs::Method;
using model::springs::Oscillator;
using model::springs::OscillatorState;
using nlohmann::json;

// As the file writes it: JSON has no infinity.
json printed(double v) { return std::isinf(v) ? json("Infinity") : json(v); }

/// Another word is damage, which the library reports.
Integrator integrator_of(const std::string& word) {
  static const json kIntegrators{{"EXPLICIT_EULER", Integrator::kExplicitEuler},
                                 {"IMPROVED_EULER", Integrator::kImprovedEuler},
                                 {"MIDPOINT_RK2", Integrator::kRk2},
                                 {"RK4", Integrator::kRk4},
                                 {"IMPLICIT_EULER", Integrator::kImplicitEuler},
                                 {"MIDPOINT_AVERAGING", Integrator::kMidpointAveraging}};
  return kIntegrators.at(word).get<Integrator>();
}

Method method_of(const json& j) {
  return {.integrator = integrator_of(j.at("method")), .alpha = number(j.at("alpha"))};
}

Oscillator oscillator_of(const json& p) {
  return {.mass_kg = number(p.at("m")),
          .damping_Ns_per_m = number(p.at("c")),
          .stiffness_N_per_m = number(p.at("k")),
          .force_N = p.contains("f") ? number(p.at("f")) : 0.0};
}

json oscillator_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  const Oscillator o = oscillator_of(p);
  const Method method = method_of(inputs);
  const double h = number(p.at("h"));
  const auto steps = inputs.at("steps").get<int>();
  const OscillatorState start{number(inputs.at("x0")), number(inputs.at("v0"))};
  OscillatorState at = start;
  for (int i = 0; i < steps && at.status == model::law::LawStatus::kOk; ++i)
    at = model::springs::step(o, at, method, h);
  if (at.status != model::law::LawStatus::kOk) return {{"status", "INVALID_ARGUMENT"}};
  const double omega = std::sqrt(o.stiffness_N_per_m / o.mass_kg);
  // Without a spring z is zero, and zeta does not matter.
  const double zeta = omega > 0.0 ? o.damping_Ns_per_m / (2.0 * o.mass_kg * omega) : 0.0;
  const OscillatorState truth = model::springs::exact(o, start, h * steps);
  return {{"status", "OK"},
          {"x", at.position_m},
          {"v", at.velocity_mps},
          {"x_exact", truth.position_m},
          {"v_exact", truth.velocity_mps},
          {"rho", model::springs::spectral_radius(
                      model::springs::amplification(method, h * omega, zeta))}};
}

json stability_results(const json& one_case) {
  const Method method = method_of(one_case.at("params"));
  const double z = number(one_case.at("inputs").at("z"));
  const double zeta = number(one_case.at("inputs").at("zeta"));
  const model::springs::Amplification m = model::springs::amplification(method, z, zeta);
  return {{"M", m},
          {"trace", model::springs::trace(m)},
          {"det", model::springs::determinant(m)},
          {"rho", model::springs::spectral_radius(m)},
          {"stable", model::springs::is_stable(m)},
          {"z_max", printed(model::springs::largest_stable_z(method, zeta))}};
}

struct RmsError {
  double position_m = 0.0, velocity_mps = 0.0;
};

/// Over all step ends in (0, T].
RmsError rms_error(const json& one_case, const Method& method, double h) {
  const Oscillator o = oscillator_of(one_case.at("params"));
  const json& inputs = one_case.at("inputs");
  const OscillatorState start{number(inputs.at("x0")), number(inputs.at("v0"))};
  const auto steps = static_cast<int>(std::lround(number(inputs.at("T")) / h));
  OscillatorState at = start;
  RmsError sum;
  for (int i = 1; i <= steps; ++i) {
    at = model::springs::step(o, at, method, h);
    const OscillatorState truth = model::springs::exact(o, start, h * i);
    sum.position_m += std::pow(at.position_m - truth.position_m, 2);
    sum.velocity_mps += std::pow(at.velocity_mps - truth.velocity_mps, 2);
  }
  return {std::sqrt(sum.position_m / steps), std::sqrt(sum.velocity_mps / steps)};
}

/// "RK4", or "MIDPOINT_AVERAGING@0.375".
Method method_named(const std::string& name) {
  const std::size_t at = name.find('@');
  if (at == std::string::npos) return {.integrator = integrator_of(name)};
  return {.integrator = integrator_of(name.substr(0, at)), .alpha = std::stod(name.substr(at + 1))};
}

void verify_claims(const json& file, Report& report) {
  const Tolerance tolerance = Tolerance::of_file(file);
  const double abs = tolerance.abs.at("any");
  for (const json& one_case : file.at("cases")) {
    report.begin_case(one_case.at("id"));
    for (const auto& [step, methods] : one_case.at("expect").at("errors").items()) {
      // "h=0.1"; a word that is no number throws, which main.cc reports as damage.
      const double h = std::stod(step.substr(step.find('=') + 1));
      double least = std::numeric_limits<double>::infinity();
      std::string best;
      for (const auto& [name, want] : methods.items()) {
        const RmsError got = rms_error(one_case, method_named(name), h);
        const std::string where = fmt::format("{} {} ", step, name);
        report.compare(where + "rms_x", got.position_m, want.at("rms_x"), true, abs, tolerance.rel);
        report.compare(where + "rms_v", got.velocity_mps, want.at("rms_v"), true, abs,
                       tolerance.rel);
        // MA-19 is about alpha: the other methods take no part.
        if (name.find('@') == std::string::npos || got.velocity_mps >= least) continue;
        least = got.velocity_mps;
        best = name.substr(name.find('@') + 1);
      }
      report.equal(step + " best alpha", best,
                   one_case.at("expect").at("best_alpha_by_rms_v").at(step));
    }
  }
}

Vec3 vector_of(const json& j) { return {number(j.at(0)), number(j.at(1)), number(j.at(2))}; }

json list_of(const std::vector<Vec3>& vectors) {
  json out = json::array();
  for (const Vec3& v : vectors) out.push_back({v.x, v.y, v.z});
  return out;
}

json network_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  std::vector<Vec3> x, v, load;
  std::vector<double> inverse, anchor, drag;
  for (const json& node : p.at("nodes")) {
    x.push_back(vector_of(node.at("x")));
    v.push_back(vector_of(node.at("v")));
    // An infinite mass does not move.
    inverse.push_back(node.at("fixed").get<bool>() ? 0.0 : 1.0 / number(node.at("m")));
    // The published networks have no anchors; those are ours.
    anchor.push_back(0.0);
    drag.push_back(number(p.at("global_damping")));
  }
  for (const json& f : inputs.at("f_ext")) load.push_back(vector_of(f));
  std::vector<model::springs::Spring> springs;
  for (const json& s : p.at("springs"))
    springs.push_back({s.at("i").get<std::uint32_t>(), s.at("j").get<std::uint32_t>(),
                       number(s.at("k")), number(s.at("c")), number(s.at("L0"))});
  const std::vector<Vec3> rest = x;
  const model::springs::SpringNetwork network{
      .node = {x, v, rest, load, inverse, anchor, drag}, .spring = springs, .probe = {}};
  model::springs::SpringStepper stepper(x.size(), springs.size());
  for (int i = 0; i < inputs.at("steps").get<int>(); ++i)
    stepper.step(network, {.method = method_of(inputs), .step_s = number(p.at("h"))});
  return {{"x", list_of(x)}, {"v", list_of(v)}};
}

constexpr Verifier kVerifiers[] = {
    {"integrator_oscillator", verify_cases<oscillator_results>},
    {"integrator_stability", verify_cases<stability_results>},
    {"integrator_claims", verify_claims},
    {"mass_spring_network", verify_cases<network_results>},
};

}  // namespace springs_cases

std::span<const Verifier> spring_verifiers() { return springs_cases::kVerifiers; }

}  // namespace tact::tools::verify
