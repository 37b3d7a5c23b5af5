// SPDX-License-Identifier: Apache-2.0
// Spot checks with the whole controller: loop, contact, gate and the simulated Delta with its hand.
//
// A wall is pressed with 2 N in the middle of the workspace; the largest stiffness without lasting
// oscillation is found by bisection, once with the controller (rt_loop.h on a simulated clock,
// hal/sim) and once with the independent loop of one degree of freedom that has the same mass,
// damping, delay and hand. The Delta moves in steps of h <= 0.25 ms in which a held force takes it
// as far as it really would, so all three must agree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta.h"
#include "hal/sim/sim_delta_model.h"
#include "model/indent/rhombus_patch.h"
#include "model/law/haptic_limit.h"
#include "model/scene/tissue.h"
#include "tools/program/simulated_loop.h"
#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/loop/haptic_loop.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

using model::Vec3;

constexpr const char* kBounces = "bounces on the surface within the limits of the gate";
constexpr double kRadius_m = 0.004;  // of the tip
constexpr double kPush_N = 2.0;
// The independent loop has the same hand.
constexpr double kHandMass_kg = 0.05, kHand_N_per_m = 50.0;
// The swing of one second is compared, two seconds after the hand has arrived and at the end.
constexpr double kApproach_s = 2.0, kFirst_s = 4.0, kRun_s = 10.0, kWindow_s = 1.0;

struct Settings {
  std::vector<double> rate_Hz, delay_s, damping_Nms_per_rad;
  double precision = 1.05;
};

Settings settings(Extent extent) {
  if (extent == Extent::kQuick)
    return {.rate_Hz = {1000.0},
            .delay_s = {0.5e-3},
            .damping_Nms_per_rad = {0.05, 0.2},
            .precision = 1.2};
  return {.rate_Hz = {1000.0, 4000.0},
          .delay_s = {0.0, 0.5e-3, 2e-3},
          .damping_Nms_per_rad = {0.02, 0.05, 0.2}};
}

Axes<3> axes(const Settings& s) {
  return {{s.rate_Hz.size(), s.delay_s.size(), s.damping_Nms_per_rad.size()}};
}

/// A square plate in z = 0 that faces up.
model::mesh::SurfaceMesh make_plate() {
  constexpr double kHalf_m = 0.1;
  const std::vector<Vec3> corner{{-kHalf_m, -kHalf_m, 0},
                                 {kHalf_m, -kHalf_m, 0},
                                 {kHalf_m, kHalf_m, 0},
                                 {-kHalf_m, kHalf_m, 0}};
  return *model::mesh::make_surface_mesh(corner, {{0, 1, 2}, {0, 2, 3}});
}

/// One rhombus without tangential spring is a linear spring: a wall of kN.
model::scene::Scene wall_scene(double stiffness_N_per_m, double rate_Hz,
                               const hal::sim::SimDeviceSettings& device) {
  model::scene::Scene scene;
  scene.path = "wall";
  scene.rate_Hz = rate_Hz;
  scene.laws.of<model::indent::RhombusParameters>().chain = {
      .rod_length_m = 0.1,
      .initial_angle_rad = 0.5,
      .normal_stiffness_N_per_m = stiffness_N_per_m,
      .tangential_stiffness_N_per_m = 0.0,
      .growth = 1.0,
      .units = 1};
  scene.contact.tear_force_N = 1.0;
  scene.tool.spheres = {{{}, kRadius_m}};
  scene.device.kind = "sim-delta";
  scene.device.of<hal::sim::SimDeviceSettings>() = device;
  // Their energy budget has no end: the passivity stage must not hide the limit (gate_monitor.h).
  scene.limits = kSceneLimits;
  scene.organ_mesh = make_plate();
  // the hand's spring is stretched by the push when the tool rests at its depth
  const double aim_m = kRadius_m - kPush_N / stiffness_N_per_m - kPush_N / kHand_N_per_m;
  scene.hand.mass_kg = kHandMass_kg;
  scene.hand.stiffness_N_per_m = kHand_N_per_m;
  scene.hand.path = {{.time_s = 0.0, .position_m = {0, 0, 0.01}},
                     {.time_s = kApproach_s, .position_m = {0, 0, aim_m}}};
  return scene;
}

struct Swing {
  double low_m = 1.0, high_m = -1.0;

  void add(double z_m) {
    low_m = std::min(low_m, z_m);
    high_m = std::max(high_m, z_m);
  }
  double size_m() const { return high_m - low_m; }
};

struct ControllerRun {
  bool grows = false;
  double max_force_N = 0.0, max_step_N = 0.0;
};

ControllerRun run_controller(double stiffness_N_per_m, double rate_Hz,
                             const hal::sim::SimDeviceSettings& device_settings) {
  const model::scene::Scene scene = wall_scene(stiffness_N_per_m, rate_Hz, device_settings);
  const auto tissue = model::scene::make_tissue(scene);
  const auto device =
      hal::sim::make_sim_delta(scene.device.of<hal::sim::SimDeviceSettings>(), scene.hand);
  if (!tissue || !device) {  // the scene is ours, above: a map of nothing would prove nothing
    fmt::print(stderr, "tact-lab stability: {}\n",
               tissue ? device.error().message : tissue.error().message);
    std::abort();
  }
  program::SimulatedLoop loop((*tissue)->contact_scene(), scene.limits, rate_Hz, **device);
  ControllerRun out;
  Vec3 before_N;
  Swing first, last;
  const int ticks = static_cast<int>(kRun_s * rate_Hz);
  for (int i = 0; i < ticks; ++i) {
    // What the gate lets through, not what contact asks for.
    const Vec3& force_N = loop.step().output.written.force_N;
    out.max_force_N = std::max(out.max_force_N, norm(force_N));
    out.max_step_N = std::max(out.max_step_N, norm(force_N - before_N));
    before_N = force_N;
    const double now_s = i / rate_Hz, z_m = (*device)->true_position_W_m().z;
    if (now_s >= kFirst_s && now_s < kFirst_s + kWindow_s) first.add(z_m);
    if (now_s >= kRun_s - kWindow_s) last.add(z_m);
  }
  // what does not get smaller grows, what still leaves the surface bounces; a micrometre is rest
  out.grows =
      last.size_m() > 1e-6 && (last.size_m() > 0.98 * first.size_m() || last.high_m > kRadius_m);
  return out;
}

double largest_by_controller(double rate_Hz, const hal::sim::SimDeviceSettings& device, double low,
                             double high, double precision) {
  // No limit within the bounds: 0 says so.
  if (run_controller(low, rate_Hz, device).grows) return 0.0;
  while (high / low > precision) {
    const double middle = std::sqrt(low * high);
    (run_controller(middle, rate_Hz, device).grows ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// The device along z in the middle of the workspace.
struct AtTool {
  double damping_Ns_per_m = 0.0, mass_kg = 0.0;
};
AtTool at_tool(double joint_damping_Nms_per_rad) {
  const hal::delta::DeltaKinematics delta(hal::sim::kGeometry);
  // At the contact with the plate the device's damping and mass depend on the pose.
  const Vec3 p_D = hal::sim::point_D({0.0, 0.0, kRadius_m});
  const hal::delta::DeltaPose pose = delta.pose(p_D, delta.inverse(p_D).theta_rad);
  const Vec3 up_D = hal::sim::direction_D({0.0, 0.0, 1.0});
  AtTool out;
  // b = c |K e|^2,  m = e . M e
  for (const double rate : hal::delta::joint_rates_radps(pose, up_D))
    out.damping_Ns_per_m += joint_damping_Nms_per_rad * rate * rate;
  const model::Mat3 mass =
      hal::delta::task_inertia_kg(hal::sim::kGeometry, hal::sim::kMasses, pose);
  out.mass_kg = dot(up_D, mass * up_D);
  return out;
}

report::Row run(std::size_t job, Extent extent) {
  const Settings s = settings(extent);
  const auto [rate, delay, damping] = axes(s).at(job);
  // Hardly any encoder step, and no friction: HL-1 alone is the limit.
  const hal::sim::SimDeviceSettings device{
      .counts_per_turn = 1e7,
      .sample_delay_s = s.delay_s[delay],
      .joint_friction_Nm = 0.0,
      .joint_damping_Nms_per_rad = s.damping_Nms_per_rad[damping],
      .observer_bandwidth_Hz = 40.0};
  const AtTool tool = at_tool(device.joint_damping_Nms_per_rad);
  LoopCase loop;
  loop.device = {.damping_Ns_per_m = tool.damping_Ns_per_m, .delay_s = device.sample_delay_s};
  loop.rate_Hz = s.rate_Hz[rate];
  loop.mass_kg = tool.mass_kg;
  loop.hand = {.mass_kg = kHandMass_kg, .stiffness_N_per_m = kHand_N_per_m};
  const double theory = model::law::haptic_limit(loop.device, loop.rate_Hz).grow_N_per_m;
  const double measured =
      largest_by_controller(loop.rate_Hz, device, 0.3 * theory, 10.0 * theory, s.precision);
  const ControllerRun beyond = run_controller(3.0 * std::max(measured, 1.0), loop.rate_Hz, device);
  const double step_limit_N = kSceneLimits.slew_N_per_s / loop.rate_Hz + 1e-12;
  const bool bounded =
      beyond.max_force_N <= kSceneLimits.force_N && beyond.max_step_N <= step_limit_N;
  return {{"rate_Hz", loop.rate_Hz},
          {"delay_s", loop.device.delay_s},
          {"joint_damping_Nms_per_rad", device.joint_damping_Nms_per_rad},
          {"damping_at_tool_Ns_per_m", tool.damping_Ns_per_m},
          {"mass_at_tool_kg", tool.mass_kg},
          {"theory_grow_N_per_m", theory},
          {"one_degree_N_per_m", largest_wall_N_per_m(loop, Verdict::kGrow)},
          {"controller_N_per_m", measured},
          {"controller_over_theory", measured / theory},
          {"max_force_N", beyond.max_force_N},
          {"max_step_N", beyond.max_step_N},
          {"beyond_the_line", !bounded       ? kOutOfBounds
                              : beyond.grows ? kBounces
                                             : "comes to rest"}};
}

}  // namespace

Map delta_loop_map() {
  return {.letter = 'c',
          .name = "loop_delta",
          .purpose = "spot checks: the real controller with the simulated Delta and its hand",
          .jobs = [](Extent extent) { return axes(settings(extent)).jobs(); },
          .run = run};
}

}  // namespace tact::tools::stability
