// SPDX-License-Identifier: Apache-2.0
// spring_step_check.h - is this step short enough for these springs? Asked once, before the loop.
//
//     every node       omega_i^2 <= (sum of k (1 + [other end moves]) + a_i + q) / m_i
//     every omega up   tau_low omega / 2 <= zeta <= (tau_high omega + max (g_i / m_i) / omega) / 2
//     to the largest   h <= 0.8 z_max(zeta) / omega, else refused
//
//     k, a  spring, anchor, N/m    q  probes, N/m    m  mass, kg    g  drag, N s/m    tau  c / k, s
//
// The lower frequencies are asked too, since z_max is no falling function of zeta and drag damps
// the slow modes most. tau_low is the smallest of all ratios of damping to stiffness: one undamped
// spring makes it 0, and integrators that need damping are refused. Source: MA-20.
#pragma once

#include <optional>

#include "model/result.h"
#include "model/springs/integrator_stability.h"
#include "model/springs/spring_network.h"

namespace tact::model::springs {

/// Tool springs that may press on any one node.
struct ProbeLoad {
  double stiffness_N_per_m = 0.0;  // q, of all together
  double damping_time_s = 0.0;
};

struct StepLimit {
  double step_s = 0.0;                               // longest allowed: 0.8 of where it grows
  double omega_radps = 0.0;                          // bound of the fastest mode
  double critical_radps = 0.0, critical_zeta = 0.0;  // the mode that decides
  std::size_t fastest_node = 0;
};

StepLimit step_limit(const SpringNetwork& network, const Method& method, const ProbeLoad& probe);

/// The message that says what to change, or nothing.
std::optional<Error> check_step(const SpringNetwork& network, const StepRule& rule,
                                const ProbeLoad& probe);

}  // namespace tact::model::springs
