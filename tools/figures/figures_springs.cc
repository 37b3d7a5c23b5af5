// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "model/springs/integrators.h"
#include "tools/figures/figures.h"

namespace tact::tools::figures {
namespace {

using model::springs::exact;
using model::springs::Integrator;
using model::springs::Method;
using model::springs::Oscillator;
using model::springs::OscillatorState;

constexpr double kEnd_s = 10.0;
/// Its oscillator is lost; this one is that of MA-19, on which all its claims hold together.
constexpr Oscillator kMass{.mass_kg = 1.0, .damping_Ns_per_m = 1.2, .stiffness_N_per_m = 4.0};
constexpr OscillatorState kKick{.position_m = 0.0, .velocity_mps = 1.0};
constexpr Method kExplicit{Integrator::kExplicitEuler}, kImproved{Integrator::kImprovedEuler};

Method midpoint(double alpha) { return {Integrator::kMidpointAveraging, alpha}; }
double spring_and_damper_N(const OscillatorState& at) {
  return -kMass.stiffness_N_per_m * at.position_m - kMass.damping_Ns_per_m * at.velocity_mps;
}

/// RMS error of the velocity over 10 s.
double velocity_rms_mps(const Method& method, double step_s) {
  const long steps = std::lround(kEnd_s / step_s);
  OscillatorState at = kKick;
  double sum = 0.0;
  for (long i = 1; i <= steps; ++i) {
    at = model::springs::step(kMass, at, method, step_s);
    const double truth = exact(kMass, kKick, step_s * static_cast<double>(i)).velocity_mps;
    sum += std::pow(at.velocity_mps - truth, 2);
  }
  return std::sqrt(sum / static_cast<double>(steps));
}

/// The truth and what each method makes of it at the steps of the first 6 s; of(state) is drawn.
template <std::size_t N, typename Of>
std::vector<report::Row> runs(const std::array<Method, N>& methods, double step_s, Of of) {
  std::vector<report::Row> rows;
  std::array<OscillatorState, N> at;
  at.fill(kKick);
  const long steps = std::lround(6.0 / step_s);
  for (long i = 0; i <= steps; ++i) {
    const double time_s = step_s * static_cast<double>(i);
    report::Row row{step_s, time_s, of(exact(kMass, kKick, time_s))};
    for (std::size_t k = 0; k < N; ++k) {
      row.emplace_back(of(at[k]));
      at[k] = model::springs::step(kMass, at[k], methods[k], step_s);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void append(std::vector<report::Row>& rows, std::vector<report::Row> more) {
  for (report::Row& row : more) rows.push_back(std::move(row));
}

}  // namespace

Figure euler_methods() {
  // The scalar equation of the figure is lost: y' = y - 2 x/y is ours, its step is as printed.
  constexpr double kStep = 0.05;
  const auto slope = [](double x, double y) { return y - 2.0 * x / y; };
  double forward = 1.0, backward = 1.0, rk4 = 1.0;
  std::vector<report::Row> rows{{0.0, 0.0, 0.0, 0.0}};
  for (int i = 0; i < 20; ++i) {
    const double x = kStep * i, next = kStep * (i + 1), truth = std::sqrt(1.0 + 2.0 * next);
    const double k1 = slope(x, rk4), k2 = slope(x + kStep / 2, rk4 + kStep / 2 * k1);
    const double k3 = slope(x + kStep / 2, rk4 + kStep / 2 * k2),
                 k4 = slope(next, rk4 + kStep * k3);
    rk4 += kStep / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    forward += kStep * slope(x, forward);
    // with h the step: (1 - h) y+^2 - y y+ + 2 h x+ = 0
    backward = (backward + std::sqrt(backward * backward - 8.0 * kStep * (1.0 - kStep) * next)) /
               (2.0 * (1.0 - kStep));
    rows.push_back({next, forward - truth, backward - truth, rk4 - truth});
  }
  return {.name = "euler_methods",
          .of = "[4] fig. 2",
          .shows = "errors of explicit Euler, implicit Euler and RK4 on one equation",
          .numbers = {},
          .curves = curves_of("euler_methods", {"x", "explicit", "implicit", "rk4"}, rows),
          .picture = {.name = "euler_methods", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'euler_methods.csv'
set title "[4] fig. 2: error of three methods, step 0.05, y' = y - 2x/y\n\
its equation and its numbers are not in the copy: the equation is ours"
set xlabel "x"
set ylabel "y less the truth"
set key top left
plot 0 lc rgb '#444444' notitle, \
     f using 2:3 with linespoints lt 1 pt 7 title 'explicit Euler', \
     f using 2:4 with linespoints lt 2 pt 7 title 'implicit Euler', \
     f using 2:5 with linespoints lt 3 pt 7 title 'RK4'
)gp"}};
}

Figure alpha_search() {
  std::vector<report::Row> rows;
  for (int i = 0; i <= 80; ++i) {
    const double alpha = 0.3 + 0.005 * i;
    rows.push_back(
        {alpha, velocity_rms_mps(midpoint(alpha), 0.1), velocity_rms_mps(midpoint(alpha), 0.4)});
  }
  const auto best_of_three = [](double step_s) {
    return std::ranges::min(std::array{0.375, 0.5, 0.625}, {}, [step_s](double alpha) {
      return velocity_rms_mps(midpoint(alpha), step_s);
    });
  };
  return {.name = "alpha_search",
          .of = "[4] figs. 4 and 5",
          .shows = "how the best alpha is found: the error of the velocity over alpha",
          .numbers = {{"best of three alpha at 0.1 s", 0.5, best_of_three(0.1)},
                      {"best of three alpha at 0.4 s", 0.375, best_of_three(0.4)}},
          .curves = curves_of("alpha_search", {"alpha", "rms_h01_mps", "rms_h04_mps"}, rows),
          .picture = {.name = "alpha_search", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'alpha_search.csv'
set title "[4] fig. 4: RMS error of the velocity over alpha, 10 s after a kick of 1 m/s\n\
printed: of 3/8, 1/2, 5/8 the best is 1/2 at 0.1 s and 3/8 at 0.4 s; the oscillator is ours"
set xlabel "alpha"
set xrange [0.3:0.7]
set ylabel "RMS error, m/s"
set logscale y
set arrow from 0.5, graph 0 to 0.5, graph 1 nohead lc rgb '#999999' dt 3
set arrow from 0.375, graph 0 to 0.375, graph 1 nohead lc rgb '#999999' dt 3
plot f using 2:3 with lines lt 1 lw 2 title 'h = 0.1 s', \
     f using 2:4 with lines lt 2 lw 2 title 'h = 0.4 s'
)gp"}};
}

Figure alpha_curves() {
  const std::array methods{midpoint(0.5), midpoint(0.375), midpoint(0.625)};
  const auto velocity = [](const OscillatorState& at) { return at.velocity_mps; };
  std::vector<report::Row> rows = runs(methods, 0.1, velocity);
  append(rows, runs(methods, 0.4, velocity));
  return {.name = "alpha_curves",
          .of = "[4] fig. 5",
          .shows = "velocity for three alpha and two steps",
          .numbers = {},
          .curves = curves_of(
              "alpha_curves",
              {"step_s", "time_s", "truth_mps", "alpha_4_8_mps", "alpha_3_8_mps", "alpha_5_8_mps"},
              rows),
          .picture = {.name = "alpha_curves", .width_px = 1200, .height_px = 550, .script = R"gp(
f = 'alpha_curves.csv'
set multiplot layout 1,2 title "[4] fig. 5: velocity by midpoint-averaging. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "velocity, m/s"
do for [h in "0.1 0.4"] {
  set title 'h = '.h.' s'
  plot f using ($2 == h ? $3 : NaN):4 with lines lt 7 lw 2 title 'truth', \
       f using ($2 == h ? $3 : NaN):5 with points lt 1 pt 7 title '1/2', \
       f using ($2 == h ? $3 : NaN):6 with points lt 2 pt 6 title '3/8', \
       f using ($2 == h ? $3 : NaN):7 with points lt 3 pt 4 title '5/8'
}
unset multiplot
)gp"}};
}

Figure step_methods() {
  const std::array methods{kExplicit, kImproved, midpoint(0.5)};
  std::vector<report::Row> rows =
      runs(methods, 0.1, [](const OscillatorState& at) { return at.position_m; });
  const std::vector<report::Row> force = runs(methods, 0.1, spring_and_damper_N);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 2; k < force[i].size(); ++k) rows[i].push_back(force[i][k]);
  return {.name = "step_methods",
          .of = "[4] fig. 7",
          .shows = "displacement and force of one mass by three methods",
          .numbers = {},
          .curves = curves_of("step_methods",
                              {"step_s", "time_s", "truth_m", "explicit_m", "improved_m",
                               "midpoint_m", "truth_N", "explicit_N", "improved_N", "midpoint_N"},
                              rows),
          .picture = {.name = "step_methods", .width_px = 1200, .height_px = 550, .script = R"gp(
f = 'step_methods.csv'
set multiplot layout 1,2 title "[4] fig. 7: one mass by three methods, h = 0.1 s. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "displacement, m"
set yrange [-0.25:0.45]
plot f using 3:4 with lines lt 7 lw 2 title 'truth', \
     f using 3:5 with lines lt 2 title 'explicit Euler', \
     f using 3:6 with lines lt 3 title 'improved Euler', \
     f using 3:7 with points lt 1 pt 7 title 'midpoint-averaging'
set ylabel "force on the mass, N"
set yrange [*:*]
plot f using 3:8 with lines lt 7 lw 2 title 'truth', \
     f using 3:9 with lines lt 2 title 'explicit Euler', \
     f using 3:10 with lines lt 3 title 'improved Euler', \
     f using 3:11 with points lt 1 pt 7 title 'midpoint-averaging'
unset multiplot
)gp"}};
}

Figure step_sizes() {
  const std::array methods{kExplicit, kImproved, midpoint(0.5)};
  const auto position = [](const OscillatorState& at) { return at.position_m; };
  std::vector<report::Row> rows;
  for (const double step_s : {0.02, 0.1, 0.4}) append(rows, runs(methods, step_s, position));
  return {.name = "step_sizes",
          .of = "[4] fig. 8",
          .shows = "displacement by three methods at three steps",
          .numbers = {},
          .curves = curves_of(
              "step_sizes",
              {"step_s", "time_s", "truth_m", "explicit_m", "improved_m", "midpoint_m"}, rows),
          .picture = {.name = "step_sizes", .width_px = 1500, .height_px = 550, .script = R"gp(
f = 'step_sizes.csv'
set multiplot layout 1,3 title "[4] fig. 8: one mass by three methods at three steps. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "displacement, m"
set yrange [-0.5:0.8]
do for [k=1:3] {
  set title (k == 1 ? '(a) explicit Euler' : k == 2 ? '(b) improved Euler' : '(c) midpoint-averaging')
  plot f using ($2 == 0.02 ? $3 : NaN):4 with lines lt 7 lw 2 title 'truth', \
       f using ($2 == 0.02 ? $3 : NaN):(column(4+k)) with lines lt 1 title 'h = 0.02 s', \
       f using ($2 == 0.1 ? $3 : NaN):(column(4+k)) with points lt 3 pt 7 title '0.1 s', \
       f using ($2 == 0.4 ? $3 : NaN):(column(4+k)) with linespoints lt 2 pt 6 title '0.4 s'
}
unset multiplot
)gp"}};
}

}  // namespace tact::tools::figures
