#include "model/spring_step_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace tact::model {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMargin = 0.8;

/// What the modes of a network lie between.
struct Bounds {
  double omega_radps = 0.0;
  std::size_t fastest_node = 0;
  double low_s = kInfinity, high_s = 0.0;  // tau
  double drag_per_s = 0.0;                 // max g / m

  void add_ratio(double damping, double stiffness) {
    if (!(stiffness > 0.0)) return;
    low_s = std::min(low_s, damping / stiffness);
  }
};

Bounds bounds_of(const SpringNetwork& network, const ProbeLoad& probe) {
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  Bounds out;
  std::vector<double> sum_N_per_m(n, probe.stiffness_N_per_m);
  out.add_ratio(probe.damping_time_s * probe.stiffness_N_per_m, probe.stiffness_N_per_m);
  out.high_s = probe.damping_time_s;
  for (const Spring& s : network.spring) {
    const double k = s.stiffness_N_per_m;
    sum_N_per_m[s.i] += node.inverse_mass_per_kg[s.j] > 0.0 ? 2.0 * k : k;
    sum_N_per_m[s.j] += node.inverse_mass_per_kg[s.i] > 0.0 ? 2.0 * k : k;
    out.add_ratio(s.damping_Ns_per_m, k);
    if (k > 0.0) out.high_s = std::max(out.high_s, s.damping_Ns_per_m / k);
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double inverse = node.inverse_mass_per_kg[i];
    if (!(inverse > 0.0)) continue;
    out.add_ratio(node.drag_Ns_per_m[i], node.anchor_N_per_m[i]);
    out.drag_per_s = std::max(out.drag_per_s, node.drag_Ns_per_m[i] * inverse);
    const double square = (sum_N_per_m[i] + node.anchor_N_per_m[i]) * inverse;
    if (square > largest) largest = square, out.fastest_node = i;
  }
  out.omega_radps = std::sqrt(largest);
  if (std::isinf(out.low_s)) out.low_s = 0.0;
  return out;
}

std::string text(const char* format, double v) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, v);
  return buffer;
}

}  // namespace

StepLimit step_limit(const SpringNetwork& network, const Method& method, const ProbeLoad& probe) {
  const Bounds bounds = bounds_of(network, probe);
  StepLimit out{.step_s = kInfinity,
                .omega_radps = bounds.omega_radps,
                .critical_radps = bounds.omega_radps,
                .fastest_node = bounds.fastest_node};
  if (bounds.omega_radps == 0.0) return out;
  for (int octave_quarter = 0; octave_quarter <= 48; ++octave_quarter) {
    const double omega = bounds.omega_radps * std::exp2(-0.25 * octave_quarter);
    const double low = 0.5 * bounds.low_s * omega;
    const double high = 0.5 * (bounds.high_s * omega + bounds.drag_per_s / omega);
    for (int share = 0; share <= 4; ++share) {
      const double zeta = low + 0.25 * share * (std::max(low, high) - low);
      const double step_s = kMargin * largest_stable_z(method, zeta) / omega;
      if (step_s >= out.step_s) continue;
      out.step_s = step_s;
      out.critical_radps = omega;
      out.critical_zeta = zeta;
    }
  }
  return out;
}

std::optional<Error> check_step(const SpringNetwork& network, const StepRule& rule,
                                const ProbeLoad& probe) {
  if (!(rule.step_s > 0.0) || std::isinf(rule.step_s))
    return Error{"springs: the step must be finite and above 0 s"};
  const StepLimit limit = step_limit(network, rule.method, probe);
  if (rule.step_s <= limit.step_s) return std::nullopt;
  const std::string name(name_of(rule.method.integrator));
  const std::string mode = text("%.4g rad/s", limit.critical_radps) +
                           text(" at damping ratio %.3g", limit.critical_zeta);
  if (!(limit.step_s > 0.0))
    return Error{"springs: " + name + " is stable with no step at " + mode +
                 "; add damping to every spring, or take midpoint-averaging with alpha 0.5"};
  // the mass that would do scales with the square of the step while zeta stays
  return Error{"springs: " + name + " blows up with a step of " + text("%.4g s", rule.step_s) +
               ": a mode near node " + std::to_string(limit.fastest_node) + " reaches " + mode +
               text(" and allows %.4g s", limit.step_s) + "; take " +
               text("%.0f times as many substeps", std::ceil(rule.step_s / limit.step_s)) +
               text(", %.3g times the mass", std::pow(rule.step_s / limit.step_s, 2)) +
               ", softer springs or implicit-euler"};
}

}  // namespace tact::model
