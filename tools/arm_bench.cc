// tact-arm-bench: how long does the pose of the arm that holds the tool take? Google Benchmark.
//
// Seven joints, warm start, a tool that presses, slides and wanders for 30 s at 60 frames/s, now
// and then farther than the arm alone spans. The same with classical CCD over the full chain.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/tracking/figure.h"
#include "tools/common/median_reporter.h"

namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using tact::host::ArmGoal;
using tact::host::Pose;
using tact::host::RootRule;
using tact::host::ToolArm;

constexpr double kFrame_s = 1.0 / 60.0, kMotion_s = 30.0, kGoal_us = 50.0;

std::vector<Pose> motion() {
  std::vector<Pose> out;
  for (double t_s = 0.0; t_s < kMotion_s; t_s += kFrame_s) {
    const double far = std::pow(std::max(0.0, std::sin(2.0 * M_PI * t_s / 10.0)), 3);
    out.push_back({.rotation = AngleAxisd(0.25 * std::sin(0.9 * t_s), Vector3d::UnitX()) *
                               AngleAxisd(0.20 * std::sin(1.3 * t_s), Vector3d::UnitZ()),
                   .position_m = {0.04 * std::sin(1.1 * t_s) - 0.20 * far,
                                  0.08 * std::sin(0.7 * t_s + 1.0) - 0.10 * far,
                                  0.03 + 0.03 * std::sin(1.9 * t_s)}});
  }
  return out;
}

/// In the pelvis's axes.
std::vector<ArmGoal> goals(const tact::host::BodyPlan& plan) {
  const Pose pelvis = tact::host::standing_pelvis(plan);
  std::vector<ArmGoal> out;
  for (const Pose& tool : motion()) {
    const Vector3d grip_m = to_world(tool, tact::host::FigureSettings{}.grip_m);
    out.push_back({.grip_m = grip_m - pelvis.position_m,
                   .hand = (tool.rotation * tact::host::holding_hand()).normalized()});
  }
  return out;
}

void bench_arm(const std::string& name, RootRule rule) {
  tact::tools::repeat(benchmark::RegisterBenchmark(name.c_str(), [rule](benchmark::State& state) {
    const auto plan = tact::host::make_body_plan(1.75);
    const std::vector<ArmGoal> all = goals(plan);
    ToolArm arm(plan, rule);
    std::size_t i = 0;
    for (auto _ : state) {
      arm.relax(kFrame_s / tact::host::kRelax_s);
      benchmark::DoNotOptimize(arm.hold(all[i++ % all.size()]));
    }
  }));
}

void bench_figure(const std::string& name) {
  tact::tools::repeat(benchmark::RegisterBenchmark(name.c_str(), [](benchmark::State& state) {
    const std::vector<Pose> all = motion();
    tact::host::Figure figure;
    double t_s = 0.0;
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(figure.update(t_s += kFrame_s, all[i++ % all.size()], {}));
    }
  }));
}

}  // namespace

int main(int argc, char** argv) {
  bool json = false;
  CLI::App app{
      "tact-arm-bench: time of the pose of the operator's arm, 7 joints, warm start, us.\n"
      "Exit status: 0 the goal is met (median of the arm <= 50 us), 1 it is not, 2 bad usage."};
  app.add_flag("--json", json, "the numbers as one line of JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  bench_arm("arm", RootRule::kSubRootFirst);
  bench_arm("arm_full_chain", RootRule::kAlwaysFullChain);
  bench_figure("figure");
  const auto us = tact::tools::median_times_us();
  if (json) {
    fmt::print("{}\n", nlohmann::json(us).dump());
  } else {
    fmt::print("arm, median             {:6.2f} us     goal <= {:.0f}\n", us.at("arm"), kGoal_us);
    fmt::print("with the full chain     {:6.2f} us\n", us.at("arm_full_chain"));
    fmt::print("whole figure            {:6.2f} us\n", us.at("figure"));
  }
  return us.at("arm") <= kGoal_us ? 0 : 1;
}
