// SPDX-License-Identifier: Apache-2.0
// fit_prony.h - how tissue held at one depth gives way: 1 to 3 Prony terms from force over time.
//
//     F(t) = F_0 (g_0 + sum g_i exp(-t / tau_i)),   g_0 + sum g_i = 1,   all g >= 0
//
// t counts from the step, s; F_0 the force at once, N. Every law with relaxation fades so at held
// depth (relaxation.h). Times are searched, shares solved exactly for each set of times.
#pragma once

#include <vector>

#include "model/law/relaxation.h"
#include "model/result.h"

namespace tact::tools::fit {

struct HeldForce {
  double time_s = 0.0;
  double force_N = 0.0;
};

struct PronyOptions {
  std::size_t terms = 0;        // 0: the fewest that meet the residual, 3 at most
  double good_residual = 0.02;  // RMS, of F_0
};

struct PronyFit {
  std::vector<model::law::PronyTerm> terms{};  // fast first; terms without a share are left out
  double initial_N = 0.0;                      // F_0
  double residual_ratio = 0.0;                 // RMS, of F_0
  double worst_ratio = 0.0;
  bool is_good = false;  // residual_ratio within what was asked
};

model::Result<PronyFit> fit_prony(const std::vector<HeldForce>& held, const PronyOptions& options);

}  // namespace tact::tools::fit
