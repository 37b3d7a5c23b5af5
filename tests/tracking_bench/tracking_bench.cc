// SPDX-License-Identifier: Apache-2.0
// tact-tracking-bench: time and error of a body's pose from markers, and of the operator's figure.
// Google Benchmark; `--benchmark_format=json` has the errors as counters beside the times.
//
// Poses: views of a body of 15 cm with 8 markers on a sphere, turned at random, 2 m in front of the
// camera and up to 0.3 m beside its axis; 0.5 px of noise. The second camera is as far away, its
// line of sight 30 to 120 degrees from the first's. The arm: seven joints, warm start.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "hal/registry/open_device.h"
#include "host/figure/figure.h"
#include "host/pose/joint_pose.h"
#include "host/pose/one_euro.h"
#include "host/pose/robust_pose.h"
#include "host/tracking/observation_player.h"
#include "host/tracking/operator_tracker.h"
#include "model/scene/tissue.h"
#include "tests/support/tool_motion.h"
#include "tools/program/simulated_loop.h"

namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using tact::host::figure::RootRule;
using tact::host::pose::BodyView;
using tact::host::pose::Camera;
using tact::host::pose::Pose;
using tact::host::pose::PoseEstimate;
using tact::host::pose::PoseStatus;
using tact::model::Result;
using tact::tools::program::SimulatedLoop;
using namespace tact::test;
namespace figure = tact::host::figure;
namespace tracking = tact::host::tracking;

constexpr Camera kCamera{.fx_px = 1200.0, .fy_px = 1200.0, .cx_px = 960.0, .cy_px = 540.0};
constexpr double kBody_m = 0.15, kDistance_m = 2.0, kNoise_px = 0.5, kOutlier_px = 3.0;
constexpr int kMarkers = 8, kViews = 4000;
constexpr double kFrames_Hz = 60.0;

struct View {
  std::vector<Vector3d> points_m;
  std::vector<Vector2d> first_px, second_px;  // the first camera is the frame
  Pose truth{}, second{};                     // of the second: first <- second
};

class Views {
 public:
  View next() {
    View out;
    out.truth.rotation = Quaterniond{normal(), normal(), normal(), normal()}.normalized();
    out.truth.position_m = {0.3 * side(), 0.3 * side(), kDistance_m};
    for (int i = 0; i < kMarkers; ++i) {
      const Vector3d p = Vector3d{normal(), normal(), normal()}.normalized();
      out.points_m.emplace_back(0.5 * kBody_m * p);
    }
    const double angle_rad = (75.0 + 45.0 * side()) / (180.0 / std::numbers::pi);
    const Vector3d axis = Vector3d{normal(), normal(), 0.0}.normalized();
    out.second.rotation = Eigen::AngleAxisd(angle_rad, axis);
    out.second.position_m = out.truth.position_m - out.second.rotation * out.truth.position_m;
    observe(out);
    return out;
  }
  /// The same view with other noise.
  void observe(View& view) {
    project(view.points_m, view.truth, view.first_px);
    project(view.points_m, bind(view.second, view.truth), view.second_px);
  }

 private:  // draws stand in braces, which fix their order
  void project(const std::vector<Vector3d>& points_m, const Pose& pose,
               std::vector<Vector2d>& pixels_px) {
    pixels_px.clear();
    for (const Vector3d& p : points_m) {
      const Vector3d x = to_world(pose, p);
      const Vector2d noise_px = {kNoise_px * normal(), kNoise_px * normal()};
      const Vector2d px(kCamera.fx_px * x.x() / x.z() + kCamera.cx_px,
                        kCamera.fy_px * x.y() / x.z() + kCamera.cy_px);
      pixels_px.push_back(px + noise_px);
    }
  }
  double side() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  double normal() { return std::normal_distribution<double>()(random_); }
  std::mt19937 random_{7};
};

PoseEstimate solve(const View& view) {
  return robust_pose(kCamera, view.points_m, view.first_px, kOutlier_px);
}

BodyView view_of(const View& view, const std::vector<Vector2d>& pixels_px, const Pose& camera) {
  const PoseEstimate alone = robust_pose(kCamera, view.points_m, pixels_px, kOutlier_px);
  if (alone.status != PoseStatus::kOk) return {};
  BodyView out = body_view(kCamera, view.points_m, pixels_px, kOutlier_px, alone.pose);
  out.eye = camera;
  return out;
}

BodyView second_of(const View& view) { return view_of(view, view.second_px, view.second); }

/// The first camera's observation now, with the one that the second has had.
PoseEstimate solve_both(const View& view, const BodyView& second) {
  const BodyView both[] = {view_of(view, view.first_px, Pose{}), second};
  return both[0].points_m.empty() || second.points_m.empty() ? PoseEstimate{} : joint_pose(both);
}

void count(benchmark::State& state, const std::string& name, std::vector<double> values) {
  std::ranges::sort(values);
  if (values.empty()) values.push_back(HUGE_VAL);  // no pose meets no goal
  state.counters[name + ".median_mm"] = values[(values.size() - 1) / 2];
  state.counters[name + ".p95_mm"] = values[(values.size() - 1) * 95 / 100];
}

/// Of many views: how far off the body's own origin is, and its part across the line of sight.
void pose_errors(benchmark::State& state, bool two_cameras) {
  for (auto _ : state) {
    Views source;
    std::vector<double> off_mm, across_mm, shown_mm;
    for (int i = 0; i < kViews; ++i) {
      View view = source.next();
      const PoseEstimate got = two_cameras ? solve_both(view, second_of(view)) : solve(view);
      if (got.status != PoseStatus::kOk) continue;
      const Vector3d off = 1e3 * (got.pose.position_m - view.truth.position_m);
      const Vector3d sight = view.truth.position_m.normalized();
      off_mm.push_back(off.norm());
      across_mm.push_back((off - off.dot(sight) * sight).norm());
      if (two_cameras || i % 20 != 0) continue;
      tact::host::pose::PoseFilter filter;  // the same body at rest for two seconds, as displayed
      Pose shown;
      for (int k = 0; k < 120; ++k) {
        source.observe(view);
        if (const PoseEstimate now = solve(view); now.status == PoseStatus::kOk)
          shown = filter.next(now.pose, k * kMotionFrame_s);
      }
      shown_mm.push_back(1e3 * (shown.position_m - view.truth.position_m).norm());
    }
    state.counters["lost"] = kViews - static_cast<double>(off_mm.size());
    count(state, "raw", off_mm);
    if (two_cameras) continue;
    count(state, "raw_across_sight", across_mm);
    count(state, "shown_at_rest", shown_mm);
  }
}

void time_poses(benchmark::State& state, bool two_cameras) {
  Views source;
  std::vector<View> views;
  std::vector<BodyView> second;
  for (int i = 0; i < 256; ++i) {
    views.push_back(source.next());
    second.push_back(second_of(views.back()));
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t at = i++ % views.size();
    benchmark::DoNotOptimize(two_cameras ? solve_both(views[at], second[at]) : solve(views[at]));
  }
}

struct MotionFrame {
  double time_s = 0.0;
  Pose tool;
  tracking::TrackedOperator bodies;
};

std::vector<MotionFrame> made_up_motion(Pose (*pose_at)(double t_s), double seconds) {
  std::vector<MotionFrame> out;
  for (int i = 0; i < seconds * kFrames_Hz; ++i)
    out.push_back({i / kFrames_Hz, pose_at(i / kFrames_Hz), {}});
  return out;
}

void time_arm(benchmark::State& state) {
  const auto plan = figure::make_body_plan(1.75);
  const Pose pelvis = standing_pelvis(plan);
  std::vector<figure::ArmGoal> goals;  // in the pelvis's axes
  for (const MotionFrame& frame : made_up_motion(tool_at, kMotion_s)) {
    const Vector3d grip_m = to_world(frame.tool, figure::FigureSettings{}.grip_m);
    goals.push_back({.grip_m = grip_m - pelvis.position_m,
                     .hand = (frame.tool.rotation * figure::holding_hand()).normalized()});
  }
  figure::ToolArm arm(plan);
  std::size_t i = 0;
  for (auto _ : state) {
    arm.relax(kMotionFrame_s / figure::kRelax_s);
    benchmark::DoNotOptimize(arm.hold(goals[i++ % goals.size()]));
  }
}

/// Joint updates by CCD, and the frames in which the fingers are not at the grip.
void count_updates(benchmark::State& state, const std::vector<MotionFrame>& motion,
                   const Vector3d& grip_m, RootRule rule) {
  for (auto _ : state) {
    figure::Figure figure({.grip_m = grip_m, .root_rule = rule});
    double updates = 0, sweeps = 0, missed = 0, worst_m = 0;
    for (const MotionFrame& frame : motion) {
      const figure::FigurePose& pose = figure.update(frame.time_s, frame.tool, frame.bodies);
      updates += pose.arm.updates;
      sweeps += pose.arm.sweeps;
      missed += !pose.arm.reached;
      const Vector3d off_m = pose[figure::FigureJoint::kRightFingers] - pose.grip_m;
      worst_m = std::max(worst_m, off_m.norm());
    }
    state.counters = {{"joint_updates", updates},
                      {"sweeps", sweeps},
                      {"missed", missed},
                      {"worst_error_mm", 1e3 * worst_m}};
  }
}

/// 30 s of the tool as the scene's simulated hand moves it, and of the bodies as the recording of
/// SCENE.tracking.toml has them.
Result<std::vector<MotionFrame>> scene_motion(const tact::model::scene::Scene& scene) {
  if (!tact::hal::registry::is_simulated(scene.device))
    return tact::model::Error{scene.path +
                              ": device.kind is hardware; name a scene with a simulated hand"};
  const std::string stem = scene.path.substr(0, scene.path.rfind(".toml"));
  const auto setup = tracking::load_tracking_setup(stem + ".tracking.toml");
  if (!setup) return setup.error();
  const auto seen = tracking::read_observation_file(setup->recording);
  if (!seen) return seen.error();
  const auto tissue = make_tissue(scene);
  if (!tissue) return tissue.error();
  const auto device = tact::hal::registry::open_device(scene);
  if (!device) return device.error();
  SimulatedLoop loop((*tissue)->contact_scene(), scene.limits, scene.rate_Hz, **device);
  tracking::OperatorTracker tracker(*setup);
  std::vector<MotionFrame> out;
  auto next = seen->seen.begin();
  for (double tick = 0.0; static_cast<double>(out.size()) < kMotion_s * kFrames_Hz; ++tick) {
    const tact::model::Tool& tool = loop.step().input.sample.tool;
    const double due_s = static_cast<double>(out.size()) / kFrames_Hz;
    if (tick < due_s * scene.rate_Hz) continue;
    for (; next != seen->seen.end() && next->time_s <= due_s; ++next)
      if (const auto error = tracker.take(*next, due_s)) return *error;
    const auto& [w, x, y, z] = tool.orientation;
    const auto& p_m = tool.position_m;
    out.push_back({due_s, {{w, x, y, z}, {p_m.x, p_m.y, p_m.z}}, tracker.at(due_s)});
  }
  return out;
}

/// The median of 15 runs.
void timed(const char* name, const std::function<void(benchmark::State&)>& run) {
  auto* timed = benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMicrosecond);
  timed->Repetitions(15)->MinTime(0.1)->ReportAggregatesOnly(true);
}

void print_help() {
  fmt::print(
      "usage: tact-tracking-bench SCENE [--benchmark_filter=REGEX] [--benchmark_format=json]\n\n"
      "Time and error of a body's pose from markers in one camera and in two (joint), and of the\n"
      "operator's arm and figure. SCENE has a simulated hand and SCENE.tracking.toml; the figure\n"
      "plays both, with CCD from the shoulder and over the full chain. Other options: those of\n"
      "Google Benchmark. Exit status: 0 measured, 2 bad usage or input.\n");
}

int fail(const std::string& message) {
  fmt::print(stderr, "tact-tracking-bench: {}\n", message);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv, print_help);
  if (argc != 2) return fail("give one SCENE and options of Google Benchmark; see --help");
  const auto scene = tact::hal::registry::load_scene(argv[1], {});
  if (!scene) return fail(scene.error().message);
  const auto motion = scene_motion(*scene);
  if (!motion) return fail(motion.error().message);
  const Vector3d grip_m = figure::grip_m(summarize(scene->tool_mesh).high_m.z);
  const auto add = [&](const char* name, const std::vector<MotionFrame>& frames, RootRule rule) {
    benchmark::RegisterBenchmark(name, count_updates, frames, grip_m, rule)->Iterations(1);
  };
  for (const bool two : {false, true}) {
    timed(two ? "joint" : "pose", [two](auto& state) { time_poses(state, two); });
    benchmark::RegisterBenchmark(two ? "joint_errors" : "pose_errors", pose_errors, two)
        ->Iterations(1);
  }
  timed("arm", time_arm);
  add("scene_shoulder_first", *motion, RootRule::kSubRootFirst);
  add("scene_full_chain", *motion, RootRule::kAlwaysFullChain);
  add("far_formula_alone", made_up_motion(far_tool_at, kReach_s), RootRule::kFormulaAlone);
  add("far_with_ccd", made_up_motion(far_tool_at, kReach_s), RootRule::kSubRootFirst);
  add("turned_formula_alone", made_up_motion(turned_tool_at, kReach_s), RootRule::kFormulaAlone);
  add("turned_with_ccd", made_up_motion(turned_tool_at, kReach_s), RootRule::kSubRootFirst);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
