// tact-plan: the least law and size that is good enough for a scene, on this machine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/scene.h"
#include "tools/chart/report.h"
#include "tools/common/interrupt.h"
#include "tools/common/run_program.h"
#include "tools/plan/plan.h"

namespace {

using namespace tact::tools;  // NOLINT(google-build-using-namespace): the program of this folder
using tact::model::Error;
using tact::model::Plan;
using tact::model::Result;
using tact::model::Scene;

struct Options {
  std::string scene, reference, chart;
  std::vector<std::string> overrides;
  bool json = false, dry_run = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene, "scene file (TOML) with [tolerance]")->required();
  auto* chart = app.add_option("--chart", o.chart, "chart.json of tact-chart, of this machine");
  app.add_option("--reference", o.reference,
                 "without a chart: measure now against this JSON of tact-reference (a minute)")
      ->excludes(chart);
  app.add_option("--set", o.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_flag("--dry-run", o.dry_run, "choose, but leave the plan of tactd as it is");
  app.add_flag("--json", o.json, "print one JSON object; times in us, errors as ratios");
  app.footer(
      "The plan is kept in $XDG_CACHE_HOME/tact/plan (or ~/.cache); tactd reads it when the scene\n"
      "says law = \"auto\".\n"
      "Exit status: 0 a law is good enough, 1 none is or Ctrl-C, 2 bad usage or input.");
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("tact-plan: {}; see tact-plan --help\n", e.what());
  });
}

int fail(const Error& error) {
  const bool interrupted = was_interrupted(error);
  fmt::print(stderr, "tact-plan: {}\n",
             interrupted ? "interrupted; the plan is as it was" : error.sentence);
  return interrupted ? 1 : 2;
}

Result<std::vector<Candidate>> measure(const Options& o, const Scene& scene) {
  const auto reference = read_reference(o.reference);
  if (!reference) return reference.error();
  ChartOptions options;
  options.wish.peers = false;
  options.timing = {.ticks = 20000, .rounds = 2, .limit_s = 2.0, .instructions = false};
  const auto rows = measure_chart(scene, *reference, options);
  if (!rows) return rows.error();
  Table table = empty_chart(rows->size(), {});
  for (const ChartRow& row : *rows) table.add(table_row(row, {}));
  return candidates_of(table);
}

Result<std::vector<Candidate>> find_candidates(const Options& o, const Scene& scene) {
  if (!o.reference.empty()) return measure(o, scene);
  if (o.chart.empty())
    return Error{
        "nothing to choose by; give --reference FILE (tact-reference SCENE --out FILE) or "
        "--chart FILE (tact-chart SCENE --out DIR)"};
  const auto table = read_chart(o.chart);
  if (!table) return table.error();
  if (auto wrong = check_chart_fits(*table, scene, o.chart)) return std::move(*wrong);
  return candidates_of(*table);
}

nlohmann::json to_json(const Candidate& c) {
  return {{"law", name_of(c.sizes.law)},
          {"name", text_of(c.sizes)},
          {"force_error_ratio", c.force_error_ratio},
          {"shape_error_ratio", c.shape_error_ratio},
          {"tick_median_us", c.tick_median_us},
          {"tick_p999_us", c.tick_p999_us},
          {"memory_bytes", c.memory_bytes}};
}

void print(const Options& o, const std::vector<Candidate>& candidates, const Choice& choice,
           const std::string& written) {
  if (!o.json) {
    fmt::print("{}\n{}\n",
               choice.meets ? text_of(candidates[*choice.chosen].sizes) : "no law is good enough",
               choice.reason);
    if (!written.empty()) fmt::print("{}\n", written);
    return;
  }
  nlohmann::json out{{"meets", choice.meets}, {"reason", choice.reason}};
  if (choice.chosen) out[choice.meets ? "chosen" : "nearest"] = to_json(candidates[*choice.chosen]);
  if (choice.runner_up) out["runner_up"] = to_json(candidates[*choice.runner_up]);
  if (!written.empty()) out["plan"] = written;
  fmt::print("{}\n", out.dump(2));
}

Result<std::string> keep(const Candidate& c, const Scene& scene) {
  const auto path = tact::model::plan_path(scene.hash);
  if (!path) return path.error();
  return tact::model::write_plan({.sizes = c.sizes,
                                  .tick_p999_us = c.tick_p999_us,
                                  .force_error_ratio = c.force_error_ratio,
                                  .shape_error_ratio = c.shape_error_ratio,
                                  .machine = tact::model::machine_name(),
                                  .scene_hash = scene.hash},
                                 *path);
}

}  // namespace

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  CLI::App app{
      "Choose the least law and size that meets the scene's [tolerance] on this machine: no more\n"
      "model than the scene needs."};
  Options o;
  add_options(app, o);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const InterruptWatch watch;
  const auto scene = tact::model::load_scene(o.scene, o.overrides);
  if (!scene) return fail(scene.error());
  if (!scene->tolerance)
    return fail({o.scene + ": has no [tolerance]; add force_error_ratio, shape_error_ratio and "
                           "tick_budget_us"});
  const auto candidates = find_candidates(o, *scene);
  if (!candidates) return fail(candidates.error());
  const Choice choice = choose(*candidates, *scene->tolerance);
  std::string written;
  if (choice.meets && !o.dry_run) {
    const auto path = keep((*candidates)[*choice.chosen], *scene);
    if (!path) return fail(path.error());
    written = *path;
  }
  print(o, *candidates, choice, written);
  return choice.meets ? 0 : 1;
}
