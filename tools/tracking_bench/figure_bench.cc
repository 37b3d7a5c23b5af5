// SPDX-License-Identifier: Apache-2.0
// tact-figure-bench: what the figure of the operator costs on a scene's own motion, and what
// starting CCD at the shoulder saves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "model/io/program/within.h"
#include "tools/program/program.h"
#include "tools/tracking_bench/figure_work.h"
#include "tools/tracking_bench/tool_motion.h"

namespace {

using namespace tact::tools;
using namespace tact::tools::tracking_bench;
using nlohmann::json;
using tact::host::figure::RootRule;

constexpr double kGoalRatio = 2.0;

json to_json(const FigureWork& work) {
  return {{"frames", work.frames},
          {"joint_updates", work.updates},
          {"sweeps", work.sweeps},
          {"full_chain_frames", work.full_chain},
          {"unreached_frames", work.unreached},
          {"rms_error_m", work.rms_error_m},
          {"worst_error_m", work.worst_error_m},
          {"median_us", work.median_us},
          {"p99_us", work.p99_us}};
}

void print_row(const char* name, const FigureWork& work) {
  fmt::print("{:<16} {:>7} {:>7} {:>11} {:>10} {:>8.3f} {:>9.3f} {:>7.1f} {:>7.1f}\n", name,
             work.updates, work.sweeps, work.full_chain, work.unreached, 1e3 * work.rms_error_m,
             1e3 * work.worst_error_m, work.median_us, work.p99_us);
}

/// A motion that the two-bone formula cannot follow: without CCD and with it.
struct ReachBench {
  FigureWork formula, ccd;

  ReachBench(const std::vector<MotionFrame>& motion, const Eigen::Vector3d& grip_m)
      : formula(measure_figure(motion, grip_m, RootRule::kFormulaAlone)),
        ccd(measure_figure(motion, grip_m, RootRule::kSubRootFirst)) {}
  bool good() const { return formula.unreached > 0 && ccd.unreached == 0; }
};

json to_json(const ReachBench& reach) {
  return {{"formula_alone", to_json(reach.formula)}, {"with_ccd", to_json(reach.ccd)}};
}

struct FigureBench {
  std::string scene;
  double duration_s = 0.0;
  FigureWork first, whole;  // shoulder first; always the whole chain
  ReachBench far, turned;   // beyond the arm; a limit of the wrist in the way

  double ratio() const {
    return static_cast<double>(whole.updates) / static_cast<double>(std::max(first.updates, 1L));
  }
  bool good() const {
    return ratio() >= kGoalRatio && first.unreached == 0 && whole.unreached == 0 && far.good() &&
           turned.good();
  }
};

void print_json(const FigureBench& bench) {
  const json told{{"format", "tact-figure-bench"},
                  {"version", 1},
                  {"scene", bench.scene},
                  {"seconds", bench.duration_s},
                  {"shoulder_first", to_json(bench.first)},
                  {"full_chain", to_json(bench.whole)},
                  {"updates_ratio", bench.ratio()},
                  {"updates_ratio_goal", kGoalRatio},
                  {"reach", {{"far", to_json(bench.far)}, {"turned", to_json(bench.turned)}}},
                  {"good", bench.good()}};
  fmt::print("{}\n", tact::model::io::text_of(told));
}

void print_text(const FigureBench& bench) {
  fmt::print("{} of {:g} s, {} frames\n", bench.scene, bench.duration_s, bench.first.frames);
  fmt::print("{:<16} {:>7} {:>7} {:>11} {:>10} {:>8} {:>9} {:>7} {:>7}\n", "CCD", "updates",
             "sweeps", "whole chain", "unreached", "rms mm", "worst mm", "us", "99 %");
  print_row("shoulder first", bench.first);
  print_row("whole chain", bench.whole);
  fmt::print("joint updates, whole chain over shoulder first: {:.2f} (goal {:g})\n", bench.ratio(),
             kGoalRatio);
  fmt::print("where the two-bone formula cannot reach, {:g} s each:\n", kReach_s);
  print_row("far, alone", bench.far.formula);
  print_row("far, with CCD", bench.far.ccd);
  print_row("turned, alone", bench.turned.formula);
  print_row("turned, with CCD", bench.turned.ccd);
}

}  // namespace

int main(int argc, char** argv) {
  program::Program program(
      "tact-figure-bench",
      "Play a scene's hand and its recorded tracker to the figure of the operator, and "
      "count the joints that CCD turns: shoulder first, and always the whole chain. Then two "
      "motions that the two-bone formula cannot follow, without CCD and with it.",
      "Errors of the finger tips in mm, times of a frame of the figure in us. The check fails "
      "where the fingers do not hold the tool, the shoulder first does not save half, or the "
      "formula alone follows everything.");
  program::SceneArguments arguments;
  std::string tracking;
  double seconds = 30.0, frames_Hz = 60.0;
  bool as_json = false;
  CLI::App& app = program.options();
  arguments.add_to(app, "[hand] and a simulated device");
  app.add_option("--tracking", tracking,
                 "tracking description with a recording; default: SCENE.tracking.toml");
  app.add_option("--seconds", seconds, "length of the motion, s")
      ->check(tact::model::io::within(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--frames", frames_Hz, "frames a second")
      ->check(tact::model::io::within(1.0, 1000.0))
      ->capture_default_str();
  app.add_flag("--json", as_json, "print one JSON object");
  if (const auto status = program.parse(argc, argv)) return *status;
  const auto scene = arguments.load();
  if (!scene) return program.fail(scene.error());
  if (tracking.empty())
    tracking = arguments.path.substr(0, arguments.path.rfind(".toml")) + ".tracking.toml";
  const auto input = load_figure_input(tracking);
  if (!input) return program.fail(input.error());
  const auto motion = figure_motion(*scene, *input, seconds, frames_Hz);
  if (!motion) return program.fail(motion.error());
  const Eigen::Vector3d grip_m =
      tact::host::figure::grip_m(tact::model::mesh::summarize(scene->tool_mesh).high_m.z);
  const FigureBench bench{.scene = scene->name,
                          .duration_s = seconds,
                          .first = measure_figure(*motion, grip_m, RootRule::kSubRootFirst),
                          .whole = measure_figure(*motion, grip_m, RootRule::kAlwaysFullChain),
                          .far{made_up_motion(far_tool_at, kReach_s, frames_Hz), grip_m},
                          .turned{made_up_motion(turned_tool_at, kReach_s, frames_Hz), grip_m}};
  if (as_json)
    print_json(bench);
  else
    print_text(bench);
  return bench.good() ? 0 : 1;
}
