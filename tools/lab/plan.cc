// SPDX-License-Identifier: Apache-2.0
// tact-lab plan: the least law and size that is good enough for a scene, on this machine.
#include "tools/plan/plan.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "tools/chart/report/report.h"
#include "tools/lab/commands.h"

namespace tact::tools::lab {
namespace {

using namespace plan;
using model::Error;
using model::Result;
using model::scene::Plan;
using model::scene::Scene;

struct Options {
  program::SceneArguments scene;
  std::string reference, tool_reference, chart;
  bool json = false, dry_run = false;
};

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app, "[tolerance]");
  auto* chart = app.add_option("--chart", o.chart, "chart.json of tact-lab chart, of this machine");
  app.add_option("--reference", o.reference,
                 "without a chart: measure now against this JSON of tact-lab reference (minutes)")
      ->excludes(chart);
  app.add_option("--tool-reference", o.tool_reference,
                 "with it: the force of the whole tool counts, not that of one sphere; JSON of "
                 "tact-lab reference SCENE --tool --out FILE")
      ->needs("--reference");
  app.add_flag("--dry-run", o.dry_run, "choose, but leave the plan of tactd as it is");
  app.add_flag("--json", o.json, "print one JSON object; times in us, errors as ratios");
}

Result<std::vector<Candidate>> measure(const Options& o, const Scene& scene) {
  const auto reference = ground_truth::read_reference(o.reference);
  if (!reference) return reference.error();
  std::optional<ground_truth::ToolReference> whole_tool;
  chart::ChartOptions options;
  if (!o.tool_reference.empty()) {
    auto read = ground_truth::read_tool_reference(o.tool_reference);
    if (!read) return read.error();
    whole_tool = std::move(*read);
    options.tool_reference = &*whole_tool;
  }
  options.label = "tact-lab plan";
  // Chosen: minutes, not hours; no instructions, as a plan is chosen by time.
  options.timing = {.ticks = 20000, .rounds = 2, .limit_s = 2.0, .instructions = false};
  const auto rows = measure_chart(scene, *reference, options);
  if (!rows) return rows.error();
  report::Table table("chart");
  for (const chart::ChartRow& row : *rows) table.add(table_row(row, {}));
  return candidates_of(table);
}

Result<std::vector<Candidate>> all_candidates(const Options& o, const Scene& scene) {
  if (!o.reference.empty()) return measure(o, scene);
  if (o.chart.empty())
    return Error{
        "nothing to choose by; give --reference FILE (tact-lab reference SCENE --out FILE) or "
        "--chart DIR/chart.json (tact-lab chart SCENE --reference FILE --out DIR); either with "
        "--tool-reference FILE for the whole tool (tact-lab reference SCENE --tool --out FILE)"};
  const auto table = chart::read_chart(o.chart);
  if (!table) return table.error();
  if (auto wrong = check_chart_fits(*table, scene, o.chart)) return std::move(*wrong);
  return candidates_of(*table);
}

Result<std::vector<Candidate>> find_candidates(const Options& o, const Scene& scene) {
  auto candidates = all_candidates(o, scene);
  // Only springs can be cut.
  if (!candidates || !scene.tool.blade) return candidates;
  keep_what_cuts(*candidates);
  if (candidates->empty())
    return Error{scene.path + ": tool.blade cuts nothing but spring_patch; write [spring_patch]"};
  return candidates;
}

nlohmann::json to_json(const Candidate& c) {
  return {{"law", c.sizes.law},
          {"name", text_of(c.sizes)},
          {"judged", c.own_error_ratio ? "whole tool" : "one sphere"},
          {"force_error_ratio", c.force_error_ratio},
          {"own_error_ratio", c.own_error_ratio ? nlohmann::json(*c.own_error_ratio) : nullptr},
          {"shape_error_ratio", c.shape_error_ratio},
          {"tick_median_us", c.tick_median_us},
          {"tick_p999_us", c.tick_p999_us},
          {"memory_bytes", c.memory_bytes}};
}

void print(const Options& o, const std::vector<Candidate>& candidates, const Choice& choice,
           const std::string& written) {
  if (!o.json) {
    fmt::print("{}\n{}\n",
               choice.chosen ? text_of(candidates[*choice.chosen].sizes) : "no law was measured",
               choice.reason);
    if (!candidates.empty() && !candidates.front().own_error_ratio)
      fmt::print(
          "Evaluated by one sphere, as no --tool-reference was given: a tool of several may be "
          "farther off.\n");
    if (!written.empty()) fmt::print("{}\n", written);
    return;
  }
  nlohmann::json out{
      {"format", "tact-plan"}, {"version", 1}, {"meets", choice.meets}, {"reason", choice.reason}};
  if (choice.chosen) out["chosen"] = to_json(candidates[*choice.chosen]);
  if (choice.runner_up) out["runner_up"] = to_json(candidates[*choice.runner_up]);
  if (!written.empty()) out["plan"] = written;
  fmt::print("{}\n", model::io::text_of(out, 2));
}

/// Writes the plan that tactd reads, or removes the one without a measurement.
Result<std::string> keep(const Choice& choice, const std::vector<Candidate>& candidates,
                         const Scene& scene) {
  const auto path = model::scene::plan_path(scene.hash);
  if (!path) return path.error();
  if (!choice.chosen) {
    std::error_code ignored;
    std::filesystem::remove(*path, ignored);
    return std::string{};
  }
  const Candidate& c = candidates[*choice.chosen];
  return model::scene::write_plan({.sizes = c.sizes,
                                   .tick_p999_us = c.tick_p999_us,
                                   .force_error_ratio = c.force_error_ratio,
                                   .shape_error_ratio = c.shape_error_ratio,
                                   .machine = model::scene::machine_name(),
                                   .scene_hash = scene.hash},
                                  *path);
}

Result<int> run(const program::Program& program, Options& o) {
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  if (!scene->tolerance)
    return Error{scene->path +
                 ": has no [tolerance]; add force_error_ratio, shape_error_ratio "
                 "and tick_budget_us"};
  const auto candidates = find_candidates(o, *scene);
  if (!candidates) return program.fail(candidates.error(), "the plan is as it was");
  const Choice choice = choose(*candidates, *scene->tolerance);
  std::string written;
  if (!o.dry_run) {
    const auto path = keep(choice, *candidates, *scene);
    if (!path) return path.error();
    written = *path;
  }
  print(o, *candidates, choice, written);
  return choice.chosen ? 0 : 1;
}

}  // namespace

void add_plan(program::Program& lab) {
  lab.add<Options>(
      "plan", "the fastest law and size within the scene's [tolerance] on this machine",
      R"(No more model than the scene needs. A reference is linear elastic: compliance is checked
with large_strain off. Time is detect, render and limit of the whole tool; shape is that
under one sphere. The plan is kept in $XDG_CACHE_HOME/tact/plan (or ~/.cache); tactd
reads it when the scene says law = "auto". When no law is good enough, it is
the one with the least excess over a limit, and that is said.
Example: tact-lab plan model/scenes/liver.toml --chart chart/chart.json)",
      add_options, run);
}

}  // namespace tact::tools::lab
