// SPDX-License-Identifier: Apache-2.0
// gate_settings.h - the limits, rates and shares of force under which the gate is put to its rules:
// ordinary ones, and each edge of what a scene may say (model/scene/scene_limits.cc).
#pragma once

#include <algorithm>
#include <array>

#include "model/scene/scene.h"

namespace tact::tests {

/// Every stage can be met within a few seconds.
inline constexpr model::Limits kRulesLimits{.force_N = 8.0,
                                            .torque_Nm = 0.2,
                                            .slew_N_per_s = 1000.0,
                                            .ramp_s = 0.1,
                                            .workspace_radius_m = 0.18,
                                            .workspace_half_length_m = 0.15,
                                            .speed_mps = 1.0,
                                            .turn_radps = 10.0,
                                            .energy_J = 0.08,
                                            .recovery_W = 1e-4,
                                            .continuous_force_N = 4.0,
                                            .thermal_time_s = 0.5,
                                            .power_W = 6.0};

struct GateSetting {
  const char* name = "ordinary";
  model::Limits limits = kRulesLimits;
  double rate_Hz = 1000.0;
  double force_share = 1.0;
  const char* edge = nullptr;  // the limit that may not be smaller

  constexpr double period_s() const { return 1.0 / rate_Hz; }
};

// The least that a scene may say, from the proofs of limiter.h, energy_tank.h and thermal_limit.h.
constexpr double least_slew_N_per_s(const model::Limits& limits) {
  return limits.force_N / 0.010 + limits.force_N / limits.ramp_s;
}
constexpr double least_energy_J(const GateSetting& setting) {
  const model::Limits& l = setting.limits;
  const double speed_mps = l.speed_mps + l.torque_Nm / l.force_N * l.turn_radps;
  const double slew_N_per_s = l.slew_N_per_s - l.force_N / l.ramp_s;
  return speed_mps * l.force_N * (0.5 * l.force_N / slew_N_per_s + 1.0 / setting.rate_Hz);
}
constexpr double least_thermal_time_s(const GateSetting& setting) {
  const model::Limits& l = setting.limits;
  const double ratio = l.force_N / l.continuous_force_N;
  const double steepness = 2.0 * (ratio * ratio - 1.0);
  return std::max((1.0 + steepness) / setting.rate_Hz,
                  steepness * 0.5 * ratio * l.force_N / (l.slew_N_per_s - l.force_N / l.ramp_s));
}

/// An ordinary setting with some of it changed.
template <typename F>
constexpr GateSetting setting(const char* name, const F& change) {
  GateSetting out{.name = name};
  change(out);
  return out;
}

/// Slew, energy and thermal time as small as a scene may have them at this rate.
constexpr void put_at_edges(GateSetting& s, double rate_Hz) {
  s.rate_Hz = rate_Hz;
  s.limits.slew_N_per_s = least_slew_N_per_s(s.limits);
  s.limits.energy_J = least_energy_J(s);
  s.limits.continuous_force_N = 1.0;
  s.limits.thermal_time_s = least_thermal_time_s(s);
}

inline constexpr std::array kGateSettings{
    GateSetting{},
    setting("10 kHz", [](GateSetting& s) { s.rate_Hz = 10000.0; }),
    setting("a stock PC", [](GateSetting& s) { s.force_share = 0.25; }),
    setting("no torque", [](GateSetting& s) { s.limits.torque_Nm = 0.0; }),
    setting("no force", [](GateSetting& s) { s.limits.force_N = 0.0; }),
    setting("continuous force beyond its peak",
            [](GateSetting& s) { s.limits.continuous_force_N = 20.0; }),
    setting("least slew",
            [](GateSetting& s) {
              s.limits.slew_N_per_s = least_slew_N_per_s(s.limits);
              s.edge = "slew_N_per_s";
            }),
    setting("least energy",
            [](GateSetting& s) {
              s.limits.energy_J = least_energy_J(s);
              s.edge = "energy_J";
            }),
    setting("least thermal time, by the slew",
            [](GateSetting& s) {
              s.limits.continuous_force_N = 2.0;
              s.limits.thermal_time_s = least_thermal_time_s(s);
              s.edge = "thermal_time_s";
            }),
    setting("least thermal time, by the period",
            [](GateSetting& s) {
              s.rate_Hz = 100.0;
              s.limits.slew_N_per_s = 1e4;
              s.limits.energy_J = 0.15;
              s.limits.continuous_force_N = 2.0;
              s.limits.thermal_time_s = least_thermal_time_s(s);
              s.edge = "thermal_time_s";
            }),
    setting("all edges at 100 Hz",
            [](GateSetting& s) {
              put_at_edges(s, 100.0);
              s.edge = "energy_J";
            }),
    setting("all edges at 10 kHz on a stock PC",
            [](GateSetting& s) {
              put_at_edges(s, 10000.0);
              s.force_share = 0.25;
              s.edge = "thermal_time_s";
            }),
};

}  // namespace tact::tests
