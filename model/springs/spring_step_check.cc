// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_step_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace tact::model::springs {
namespace {

constexpr double kUnlimited_s = std::numeric_limits<double>::infinity();
// MA-20 bounds the fastest mode from above; of the step that it allows this much is taken.
constexpr double kStableStep_ratio = 0.8;

/// What the modes of a network lie between.
struct Bounds {
  double omega_radps = 0.0;
  std::size_t fastest_node = 0;
  double low_s = kUnlimited_s, high_s = 0.0;  // tau
  double drag_per_s = 0.0;                    // max g / m

  void add_ratio(double damping, double stiffness) {
    if (!(stiffness > 0.0)) return;
    low_s = std::min(low_s, damping / stiffness);
  }
};

/// MA-20, over all nodes that move.
Bounds bounds_of(const SpringNetwork& network, const ProbeLoad& probe) {
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  Bounds out;
  std::vector<double> sum_N_per_m(n, probe.stiffness_N_per_m);
  out.add_ratio(probe.damping_time_s * probe.stiffness_N_per_m, probe.stiffness_N_per_m);
  out.high_s = probe.damping_time_s;
  for (const Spring& s : network.spring) {
    const double k = s.stiffness_N_per_m;
    // Two ends that move against each other feel the spring twice (Gershgorin).
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
  // No spring has a damping ratio: assume no damping.
  if (std::isinf(out.low_s)) out.low_s = 0.0;
  return out;
}

std::string text(const char* format, double v) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, format, v);
  return buffer;
}

/// The shortest step that some mode allows: 12 octaves down, by quarters, and five dampings each.
StepLimit limit_of(const Bounds& bounds, const Method& method) {
  StepLimit out{.step_s = kUnlimited_s,
                .omega_radps = bounds.omega_radps,
                .critical_radps = bounds.omega_radps,
                .fastest_node = bounds.fastest_node};
  if (bounds.omega_radps == 0.0) return out;
  for (int quarter = 0; quarter <= 48; ++quarter) {  // of an octave
    const double omega = bounds.omega_radps * std::exp2(-0.25 * quarter);
    const double low = 0.5 * bounds.low_s * omega;
    const double high = 0.5 * (bounds.high_s * omega + bounds.drag_per_s / omega);
    // zeta of a mode lies between both; z_max is not monotone in it, so five are asked.
    for (int share = 0; share <= 4; ++share) {
      const double zeta = low + 0.25 * share * (std::max(low, high) - low);
      const double step_s = kStableStep_ratio * largest_stable_z(method, zeta) / omega;
      if (step_s >= out.step_s) continue;
      out.step_s = step_s;
      out.critical_radps = omega;
      out.critical_zeta = zeta;
    }
  }
  return out;
}

/// How many times the mass would do; empty if mass is no remedy.
std::string mass_advice(const Bounds& bounds, const StepRule& rule) {
  // In steps of a quarter; a mass 10 000 times as large is no advice.
  for (double factor = 1.25; factor < 1e4; factor *= 1.25) {
    Bounds heavier = bounds;
    heavier.omega_radps /= std::sqrt(factor);
    heavier.drag_per_s /= factor;
    if (rule.step_s <= limit_of(heavier, rule.method).step_s)
      return text(", %.3g times the mass", factor);
  }
  return "";
}

}  // namespace

StepLimit step_limit(const SpringNetwork& network, const Method& method, const ProbeLoad& probe) {
  return limit_of(bounds_of(network, probe), method);
}

std::optional<Error> check_step(const SpringNetwork& network, const StepRule& rule,
                                const ProbeLoad& probe) {
  if (!(rule.step_s > 0.0) || std::isinf(rule.step_s))
    return Error{"springs: the step must be finite and above 0 s"};
  const StepLimit limit = step_limit(network, rule.method, probe);
  if (rule.step_s <= limit.step_s) return std::nullopt;
  const std::string what = "springs: " + std::string(name_of(rule.method.integrator));
  const std::string mode = text("a mode of %.4g rad/s", limit.critical_radps) +
                           text(" with damping ratio %.3g", limit.critical_zeta);
  if (!(limit.step_s > 0.0))
    return Error{what + " is stable with no step for " + mode +
                 "; add damping to every spring, or take midpoint-averaging with alpha 0.5"};
  return Error{what + text(" blows up with a step of %.4g s: ", rule.step_s) + mode +
               text(" allows %.4g s", limit.step_s) + " (node " +
               std::to_string(limit.fastest_node) +
               text(" is the fastest); take %.0f times the substeps",
                    std::ceil(rule.step_s / limit.step_s)) +
               mass_advice(bounds_of(network, probe), rule) + ", softer springs or implicit-euler"};
}

}  // namespace tact::model::springs
