// SPDX-License-Identifier: Apache-2.0
// probed_methods.h - the integrators that the map shows, by the names of its table.
#pragma once

#include "model/springs/integrators.h"

namespace tact::tools::stability {

struct ProbedMethod {
  const char* name;
  model::springs::Method method;
};

inline constexpr ProbedMethod kProbedMethods[] = {
    {"explicit Euler", {.integrator = model::springs::Integrator::kExplicitEuler}},
    {"improved Euler", {.integrator = model::springs::Integrator::kImprovedEuler}},
    {"midpoint-averaging 3/8",
     {.integrator = model::springs::Integrator::kMidpointAveraging, .alpha = 0.375}},
    {"midpoint-averaging 1/2",
     {.integrator = model::springs::Integrator::kMidpointAveraging, .alpha = 0.5}},
    {"midpoint-averaging 5/8",
     {.integrator = model::springs::Integrator::kMidpointAveraging, .alpha = 0.625}},
    {"RK2", {.integrator = model::springs::Integrator::kRk2}},
    {"RK4", {.integrator = model::springs::Integrator::kRk4}},
    {"implicit Euler", {.integrator = model::springs::Integrator::kImplicitEuler}},
};

}  // namespace tact::tools::stability
