// SPDX-License-Identifier: Apache-2.0
// wall - a tool presses a wall by 2 mm and withdraws. Prints depth, force of the law and force
// after the gate.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "firmware/loop/controller.h"
#include "model/indent/hunt_crossley.h"
#include "model/mesh/mesh.h"
#include "model/tissue/elastic_field.h"

using namespace tact::model;
namespace loop = tact::firmware::loop;

int main() {
  constexpr double kPeriod_s = 1e-3, kRadius_m = 0.005;
  // The law: 1000 N/m, up to 4 N. The wall: a square in the plane x = 0; its outside is +x.
  const auto law = indent::make_hunt_crossley(
      {.force_N = 4.0, .working_depth_m = 0.004, .exponent = 1.0, .dissipation_s_per_m = 0.0});
  const auto wall = mesh::make_surface_mesh(
      {{0, -0.1, -0.1}, {0, 0.1, -0.1}, {0, 0.1, 0.1}, {0, -0.1, 0.1}}, {{0, 1, 2}, {0, 2, 3}});
  if (!law || !wall) return std::fputs("a number of the law or the wall is invalid\n", stderr), 2;
  const auto tree = contact::make_triangle_tree(wall->view());
  const std::array<const law::Law*, 1> curves{&*law};
  tissue::ElasticField tissue({.curves = curves, .surface = wall->view(), .relaxation = {}});

  // The tool: one sphere. The gate: at most 1.5 N, 200 N/s, full force 50 ms after arming.
  const std::array tool{contact::ProbeSphere{.offset_m = {}, .radius_m = kRadius_m}};
  const Limits limits{.force_N = 1.5,
                      .slew_N_per_s = 200.0,
                      .ramp_s = 0.05,
                      .workspace_radius_m = 0.1,
                      .workspace_half_length_m = 0.1};
  loop::Controller controller({.law = &tissue,
                               .parameters = {.tear_force_N = 1.0},
                               .spheres = tool,
                               .surface = wall->view(),
                               .tree = tree.view(),
                               .period_s = kPeriod_s},
                              tact::firmware::gate::Gate(limits, kPeriod_s, 1.0), false);

  std::puts("time, s   depth, mm   law, N   gate, N");
  for (int tick = 0; tick <= 1000; ++tick) {
    const double time_s = tick * kPeriod_s;
    const double depth_m = -0.002 - 0.004 * std::cos(2 * std::numbers::pi * time_s);
    loop::TickInput input;
    input.sample = {.tool = {.position_m = {kRadius_m - depth_m, 0, 0}},
                    .stamp_ns = tick * 1000000LL,
                    .fresh = true};
    input.commands.arm = tick > 0;  // the first sample makes the controller ready
    const loop::TickOutput out = controller.tick(input);
    if (tick % 100 == 0)
      std::printf("%7.2f %11.2f %8.3f %9.3f\n", time_s, 1e3 * depth_m, out.wanted.force_N.x,
                  out.written.force_N.x);
  }
}
