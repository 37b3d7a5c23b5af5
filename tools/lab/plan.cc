// SPDX-License-Identifier: Apache-2.0
// tact-lab plan: the least law and size that is good enough for a scene, on this machine. Measured
// here; chosen by chart/plan.py.
#include <CLI/CLI.hpp>

#include "tools/chart/compare/chart.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"
#include "tools/report/just_noticeable.h"

namespace tact::tools::lab {
namespace {

using namespace chart;
using model::Error;
using model::Result;
using model::scene::Scene;
using nlohmann::json;

struct Options {
  program::SceneArguments scene;
  std::string reference, tool_reference, finite_strain, chart;
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
  add_finite_strain(app, o.finite_strain);
  app.add_flag("--dry-run", o.dry_run, "choose, but leave the plan of tactd as it is");
  app.add_flag("--json", o.json, "print one JSON object; times in us, errors as ratios");
}

std::optional<Error> measure(json& job, const Options& o, const Scene& scene) {
  const auto reference = ground_truth::read_reference(o.reference);
  if (!reference) return reference.error();
  ChartOptions options{.label = "tact-lab plan", .request = {}, .timing = {}};
  if (auto error = add_tool_reference(job, options, scene, o.tool_reference, o.finite_strain))
    return error;
  // Chosen: minutes, not hours; no instructions, as a plan is chosen by time.
  options.timing = {.ticks = 20000, .rounds = 2, .limit_s = 2.0, .instructions = false};
  const auto rows = measure_chart(scene, *reference, options);
  if (!rows) return rows.error();
  job["rows"] = json::array();
  for (const Measured& row : *rows) job["rows"].push_back(to_json(row));
  return std::nullopt;
}

std::optional<Error> add_candidates(json& job, const Options& o, const Scene& scene) {
  if (!o.reference.empty()) return measure(job, o, scene);
  if (o.chart.empty())
    return Error{
        "nothing to choose by; give --reference FILE (tact-lab reference SCENE --out FILE) or "
        "--chart DIR/chart.json (tact-lab chart SCENE --reference FILE --out DIR); either with "
        "--tool-reference FILE for the whole tool (tact-lab reference SCENE --tool --out FILE)"};
  auto table = read_chart(o.chart);
  if (!table) return table.error();
  job["table"] = std::move(*table);
  return std::nullopt;
}

Result<int> run(const program::Program&, Options& o) {
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  if (!scene->tolerance)
    return Error{scene->path +
                 ": has no [tolerance]; add force_error_ratio, shape_error_ratio "
                 "and tick_budget_us"};
  const auto path = model::scene::plan_path(scene->hash);
  if (!o.dry_run && !path) return path.error();
  json job = {{"chart", o.chart},
              {"json", o.json},
              {"plan", o.dry_run ? "" : *path},
              {"scene", scene->path},
              {"has_blade", scene->tool.blade.has_value()},
              {"tolerance",
               {{"force_error_ratio", scene->tolerance->force_error_ratio},
                {"shape_error_ratio", scene->tolerance->shape_error_ratio},
                {"tick_budget_us", scene->tolerance->tick_budget_us}}},
              {"noticeable_ratio", report::kJustNoticeable_ratio},
              {"provenance",
               {{"scene", scene->hash},
                {"reference", ""},
                {"revision", ""},
                {"machine", model::scene::machine_name()}}}};
  for (const model::scene::LawRow& law : model::scene::all_laws())
    job["size_keys"][std::string(law.name)] = law.size_key;
  if (auto error = add_candidates(job, o, *scene)) return *error;
  return become("chart/plan.py", job);
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
