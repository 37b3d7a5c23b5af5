// probed_methods.h - the integrators that the map shows, by the names of its table.
#pragma once

#include "model/integrators.h"

namespace tact::tools {

struct ProbedMethod {
  const char* name;
  model::Method method;
};

inline constexpr ProbedMethod kProbedMethods[] = {
    {"explicit Euler", {.integrator = model::Integrator::kExplicitEuler}},
    {"improved Euler", {.integrator = model::Integrator::kImprovedEuler}},
    {"midpoint-averaging 3/8",
     {.integrator = model::Integrator::kMidpointAveraging, .alpha = 0.375}},
    {"midpoint-averaging 1/2", {.integrator = model::Integrator::kMidpointAveraging, .alpha = 0.5}},
    {"midpoint-averaging 5/8",
     {.integrator = model::Integrator::kMidpointAveraging, .alpha = 0.625}},
    {"RK2", {.integrator = model::Integrator::kRk2}},
    {"RK4", {.integrator = model::Integrator::kRk4}},
    {"implicit Euler", {.integrator = model::Integrator::kImplicitEuler}},
};

}  // namespace tact::tools
