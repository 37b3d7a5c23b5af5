// SPDX-License-Identifier: Apache-2.0
// tact-lab chart: speed against accuracy of every law of a scene. Measured here; compared, written
// and drawn by chart/chart.py.
#include "tools/chart/compare/chart.h"

#include <CLI/CLI.hpp>

#include "firmware/pc/environment.h"
#include "model/io/input_file.h"
#include "model/io/json.h"
#include "model/reader/scene_text.h"
#include "model/scene/accuracy_file.h"
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
  std::string out, reference, tool_reference, finite_strain, accuracy, peers, scenes;
  ChartOptions chart;
  bool quick = false, no_plots = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app);
  app.add_option("--out", o.out, "folder for tables and pictures; made if need be")->required();
  app.add_option("--reference", o.reference,
                 "what is true under one sphere: JSON of tact-lab reference SCENE --out FILE");
  app.add_option("--tool-reference", o.tool_reference,
                 "what is true under the whole tool, all spheres; JSON of tact-lab reference SCENE "
                 "--tool --out FILE. Alone: the scene's laws as they are; with --reference: every "
                 "size too");
  add_finite_strain(app, o.finite_strain);
  app.add_option("--accuracy", o.accuracy,
                 "with it alone: also this file, SCENE.accuracy, which tactd --check prints")
      ->needs("--tool-reference")
      ->excludes("--reference");
  app.add_option("--laws", o.chart.request.laws, "only these laws")
      ->delimiter(',')
      ->check(CLI::IsMember(all_families()));
  app.add_flag("--quick", o.quick, "fewer sizes, fewer ticks");
  app.add_option(
         "--peers", o.peers,
         "show these rows of a chart.json, measured before, beside the laws; the liver's, in "
         "the sources: peers.json among its results")
      ->needs("--reference");
  app.add_option("--scenes", o.scenes,
                 "draw the shipped scenes, too: scenes.json among the results in the sources; "
                 "finite_strain.json beside it judges those that it has")
      ->needs("--reference");
  app.add_flag("--no-pictures", o.no_plots, "tables alone; needs no matplotlib");
  app.add_flag("--json", o.json, "print the table as JSON");
}

/// Of all that were given, in this order.
std::string hash_of_files(std::initializer_list<std::string> paths) {
  model::reader::TextHash hash;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    const auto text = model::io::read_file(path);
    // The code that needs a file reports that it cannot be read, with its name.
    hash.add(text ? *text : std::string());
  }
  return hash.hex();
}

json job_of(const program::Program& program, const Options& o, const Scene& scene) {
  return {{"version", kChartVersion},
          {"out", o.out},
          {"json", o.json},
          {"draw", !o.no_plots},
          {"accuracy", o.accuracy},
          {"scenes", o.scenes},
          {"command", program.command()},
          {"scene", {{"name", scene.name}, {"path", scene.path}, {"law", scene.law}}},
          {"noticeable_ratio", report::kJustNoticeable_ratio},
          {"provenance",
           {{"scene", scene.hash},
            {"reference", hash_of_files({o.reference, o.tool_reference, o.finite_strain})},
            {"revision", firmware::pc::read_environment({}).git_revision},
            {"machine", model::scene::machine_name()}}}};
}

/// What tactd knows a law by again: its forces, not the file.
std::optional<Error> add_hashes(json& row, const Scene& scene, const std::string& law_name) {
  const auto law = model::scene::make_tissue_law(scene, law_name);
  if (!law) return law.error();
  const auto hash = model::scene::hash_of_linear_forces(scene, law_name);
  if (!hash) return hash.error();
  row["law_hash"] = *hash;
  row["large_strain_off"] = scene.compliance.large_strain && (*law)->organ() != nullptr;
  return std::nullopt;
}

Result<int> run(const program::Program& program, Options& o) {
  if (auto error = program::prepare_folder(o.out)) return *error;
  o.chart.request.quick = o.quick;
  if (o.quick) o.chart.timing = {.ticks = 5000, .rounds = 2, .limit_s = 1.0};
  if (o.reference.empty() && o.tool_reference.empty())
    return Error{"no reference given; --reference or --tool-reference is needed"};
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  json job = job_of(program, o, *scene);
  if (auto error = add_tool_reference(job, o.chart, *scene, o.tool_reference, o.finite_strain))
    return *error;
  Result<std::vector<Measured>> rows = std::vector<Measured>{};
  if (o.reference.empty()) {
    rows = measure_tool(*scene, o.chart);
  } else {
    const auto reference = ground_truth::read_reference(o.reference);
    if (!reference) return reference.error();
    // Before the work, which a file that does not fit would make vain.
    if (!o.scenes.empty())
      if (const auto scenes = model::io::read_json(o.scenes); !scenes) return scenes.error();
    auto peers = peers_of(o.peers, hash_of_files({o.reference}));
    if (!peers) return peers.error();
    job["peers"] = std::move(*peers);
    rows = measure_chart(*scene, *reference, o.chart);
  }
  if (!rows) return rows.error();
  for (const Measured& row : *rows) {
    json& out = job["rows"].emplace_back(to_json(row));
    if (o.accuracy.empty() || !row.failure.empty()) continue;
    if (auto error = add_hashes(out, *scene, row.variant.sizes.law)) return *error;
  }
  return become("chart/chart.py", job);
}

}  // namespace

void add_chart(program::Program& lab) {
  lab.add<Options>(
      "chart", "speed against accuracy of every law of a scene, and of other methods",
      R"(Measures every law of the scene in several sizes: force and shape error against the
reference, time and memory of a tick. --peers shows beside them what was measured before:
finite elements solved every tick, a mesh of springs, Bullet's soft body; --scenes the
shipped scenes. Errors are ratios of the peak force, of the local force and of the depth,
times us, memory bytes. A reference is linear elastic, so relaxation is off for the errors
and on for the times, and compliance.large_strain is off. The pictures need matplotlib.
It fails a check when a peer is ahead of tact's front.
Example: tact-lab chart model/scenes/liver.toml --reference reference.json --out chart)",
      add_options, run);
}

}  // namespace tact::tools::lab
