// SPDX-License-Identifier: Apache-2.0
// Integrators of a mass on springs: does the oscillator grow where its amplification matrix says?
//
// Per cell of z = h omega and damping ratio zeta: M of MA-10 to MA-15 gives the spectral
// radius; the step itself (model/springs/integrators.h) is run from two starts, (x, h v) = (1, 0)
// and (0, 1), and the growth a step of what comes out is measured over the second half of the run.
#include <cmath>

#include "model/springs/integrator_stability.h"
#include "model/springs/integrators.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

using model::springs::Integrator;

struct ProbedMethod {
  const char* name;
  model::springs::Method method;
};

constexpr ProbedMethod kProbedMethods[] = {
    {"explicit Euler", {Integrator::kExplicitEuler}},
    {"improved Euler", {Integrator::kImprovedEuler}},
    {"midpoint-averaging 3/8", {Integrator::kMidpointAveraging, 0.375}},
    {"midpoint-averaging 1/2", {Integrator::kMidpointAveraging, 0.5}},
    {"midpoint-averaging 5/8", {Integrator::kMidpointAveraging, 0.625}},
    {"RK2", {Integrator::kRk2}},
    {"RK4", {Integrator::kRk4}},
    {"implicit Euler", {Integrator::kImplicitEuler}},
};

constexpr int kSteps = 20'000;
constexpr int kChunk = 50;          // between two normalisations: 15^50 is still a number
constexpr double kGrows = 5e-5;     // a step, in the logarithm: what kSteps can resolve from 0
constexpr double kRounding = 1e-9;  // of the spectral radius

struct Cells {
  std::size_t z = 0, zeta = 0;
};
Cells cells(Extent extent) { return extent == Extent::kQuick ? Cells{15, 9} : Cells{60, 41}; }

double z_of(std::size_t i, Extent extent) {
  return 4.0 * static_cast<double>(i + 1) / static_cast<double>(cells(extent).z);
}
double zeta_of(std::size_t i, Extent extent) {
  return 2.0 * static_cast<double>(i) / static_cast<double>(cells(extent).zeta - 1);
}

/// ln of the growth a step, over the second half of the run.
double measured_log_growth(const model::springs::Method& method, double z, double zeta) {
  // m = 1 kg, omega = 1 rad/s: h = z, c = 2 zeta
  const model::springs::Oscillator oscillator{
      .mass_kg = 1.0, .damping_Ns_per_m = 2.0 * zeta, .stiffness_N_per_m = 1.0};
  // Two starts span the plane: one alone might lie in the direction that does not grow.
  model::springs::OscillatorState a{.position_m = 1.0}, b{.velocity_mps = 1.0 / z};
  double log_norm = 0.0, half = 0.0;
  for (int i = 0; i < kSteps; i += kChunk) {
    for (int k = 0; k < kChunk; ++k) {
      a = model::springs::step(oscillator, a, method, z);
      b = model::springs::step(oscillator, b, method, z);
    }
    // With h v for v, so that both parts are lengths and of one size.
    const double norm = std::hypot(std::hypot(a.position_m, z * a.velocity_mps),
                                   std::hypot(b.position_m, z * b.velocity_mps));
    if (!(norm > 0.0)) return -1.0;  // died out: nothing left to measure
    log_norm += std::log(norm);
    // Both by the same number: the step is linear, so nothing changes but the size.
    for (model::springs::OscillatorState* s : {&a, &b}) {
      s->position_m /= norm;
      s->velocity_mps /= norm;
    }
    if (i + kChunk == kSteps / 2) half = log_norm;
  }
  // The first half is left out: there the directions that fade still count.
  return (log_norm - half) / (0.5 * kSteps);
}

report::Row run(std::size_t job, Extent extent) {
  const auto [which, i, j] =
      Axes<3>{{std::size(kProbedMethods), cells(extent).zeta, cells(extent).z}}.at(job);
  const ProbedMethod& probed = kProbedMethods[which];
  const double zeta = zeta_of(i, extent), z = z_of(j, extent);
  // MA-10 to MA-15.
  const double radius =
      model::springs::spectral_radius(model::springs::amplification(probed.method, z, zeta));
  const double growth = measured_log_growth(probed.method, z, zeta);
  return {{"method", probed.name},
          {"zeta", zeta},
          {"z", z},
          {"theory_growth_per_step", radius},
          {"measured_growth_per_step", std::exp(growth)},
          {"theory", radius > 1.0 + kRounding ? "grows" : "bounded"},
          {"measured", growth > kGrows ? "grows" : "bounded"}};
}

/// For the picture: z_max over zeta of each method.
nlohmann::json facts() {
  constexpr int kPoints = 200;
  nlohmann::json theory = nlohmann::json::array();
  for (const auto& [name, method] : kProbedMethods)
    for (int i = 0; i <= kPoints; ++i) {
      const double zeta = 2.0 * i / kPoints;
      // Infinity is no number for gnuplot: just beyond what is shown.
      theory.push_back(
          {name, std::fmin(model::springs::largest_stable_z(method, zeta), 5.0), zeta});
    }
  return {{"theory", theory}};
}

}  // namespace

Map integrator_map() {
  return {.letter = 'a',
          .name = "integrators",
          .purpose = "growth of the oscillator over step and damping, every integrator",
          .jobs =
              [](Extent extent) {
                return std::size(kProbedMethods) * cells(extent).zeta * cells(extent).z;
              },
          .run = run,
          .facts = facts};
}

}  // namespace tact::tools::stability
