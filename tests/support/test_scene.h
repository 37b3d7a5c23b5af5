// SPDX-License-Identifier: Apache-2.0
// test_scene.h - a small scene in memory: a plate, one or two spheres, a hand that waits above it.
#pragma once

#include "hal/sim/sim_delta.h"
#include "model/indent/disc_stack.h"
#include "model/indent/rhombus_patch.h"
#include "model/scene/scene.h"
#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::tests {

inline model::scene::Scene make_plate_scene() {
  model::scene::Scene scene;
  scene.look = {.organ = "skin", .piece_color_ratio = {{1.0, 1.0, 0.5}}, .vertex_color = {}};
  scene.path = "plate.toml";
  scene.name = "plate";
  scene.rate_Hz = 1000.0;
  scene.laws.of<model::indent::RhombusParameters>().chain = {.rod_length_m = 0.005,
                                                             .initial_angle_rad = 0.5236,
                                                             .normal_stiffness_N_per_m = 150.0,
                                                             .tangential_stiffness_N_per_m = 180.0,
                                                             .growth = 2.0,
                                                             .units = 10};
  scene.table_knots = 65;
  scene.contact.friction_ratio = 0.4;
  scene.contact.sliding_stiffness_N_per_m = 100.0;
  scene.contact.tear_force_N = 0.6;
  scene.tool.spheres = {{{}, 0.004}};
  scene.device.kind = "sim-delta";
  scene.device.of<hal::sim::SimDeviceSettings>() = {.counts_per_turn = 100000.0,
                                                    .sample_delay_s = 0.0005,
                                                    .joint_friction_Nm = 0.01,
                                                    .joint_damping_Nms_per_rad = 0.02,
                                                    .observer_bandwidth_Hz = 40.0};
  scene.hand.mass_kg = 0.15;
  scene.hand.stiffness_N_per_m = 600.0;
  scene.hand.damping_Ns_per_m = 15.0;
  scene.hand.repeat = true;
  scene.hand.path = {{.time_s = 0.0, .position_m = {0, 0, 0.02}},
                     {.time_s = 1.0, .position_m = {0, 0, -0.006}},
                     {.time_s = 2.0, .position_m = {0, 0.01, -0.006}},
                     {.time_s = 3.0, .position_m = {0, 0, 0.02}}};
  scene.hand_inward = {0, 0, -1};
  scene.limits = {.force_N = 8.0,
                  .torque_Nm = 0.2,
                  .slew_N_per_s = 1000.0,
                  .ramp_s = 0.5,
                  .workspace_radius_m = 0.18,
                  .workspace_half_length_m = 0.15};
  scene.frame_rate_Hz = 60.0;
  scene.hash = "0123456789abcdef";
  scene.organ_mesh = make_plate(0.2, 20);
  scene.tool_mesh = make_ball(0.004, 1);
  return scene;
}

/// A linear stack of 20 soft discs, 8 mm across.
inline model::indent::DiscStackParameters make_linear_discs() {
  return {.disc = {.outer_diameter_m = 0.008,
                   .inner_diameter_m = 0.004,
                   .thickness_m = 0.002,
                   .free_height_m = 0.0025,
                   .youngs_modulus_Pa = 5000.0,
                   .poisson_ratio = 0.3},
          .form = model::indent::DiscForm::kLinear,
          .delays = {
              .first_delay_s = 1e-6, .delay_ratio = 1.0, .refresh_rate_Hz = 1000.0, .layers = 20}};
}

}  // namespace tact::tests
