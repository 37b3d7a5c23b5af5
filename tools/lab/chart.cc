// SPDX-License-Identifier: Apache-2.0
// tact-lab chart: speed against accuracy of every law of a scene, and of other methods.
#include "tools/chart/compare/chart.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "firmware/pc/environment.h"
#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/reader/scene_text.h"
#include "tools/chart/report/report.h"
#include "tools/chart/report/tool_report.h"
#include "tools/lab/commands.h"

namespace tact::tools::lab {
namespace {

using namespace chart;
using model::Error;
using model::Result;
using model::scene::Scene;

struct Options {
  program::SceneArguments scene;
  std::string out, reference, tool_reference, accuracy, peers;
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
  app.add_flag("--no-pictures", o.no_plots, "tables alone; needs no gnuplot");
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

Provenance provenance_of(const Scene& scene, const Options& o) {
  return {.scene_hash = scene.hash,
          .reference_hash = hash_of_files({o.reference, o.tool_reference}),
          .revision = firmware::pc::read_environment({}).git_revision,
          .machine = model::scene::machine_name()};
}

/// Evaluates the whole tool, law by law, and writes tool.csv and tool.json.
Result<int> check_whole_tool(const program::Program& program, const Options& o,
                             const Scene& scene) {
  const auto reference = ground_truth::read_tool_reference(o.tool_reference);
  if (!reference) return reference.error();
  std::vector<ToolRow> rows;
  for (const std::string& law : wanted_laws(scene, o.chart.request)) {
    auto row = check_tool(scene, law, *reference, o.chart.timing);
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) return Error{"none of the wanted laws is described; leave out --laws"};
  const Provenance provenance = provenance_of(scene, o);
  const std::string json = tool_json(rows, *reference, program.command(), provenance);
  if (auto error =
          model::io::write_file(o.out + "/tool.csv", csv_head(program.command(), provenance) +
                                                         tool_table(rows, *reference).to_csv()))
    return *error;
  if (auto error = model::io::write_file(o.out + "/tool.json", json)) return *error;
  if (!o.accuracy.empty()) {
    const auto accuracy = accuracy_of(scene, rows, *reference);
    if (!accuracy) return accuracy.error();
    if (auto error = model::io::write_file(o.accuracy, model::scene::accuracy_text(*accuracy)))
      return *error;
  }
  fmt::print("{}", o.json ? json : tool_text(rows, *reference));
  return 0;
}

Result<report::Table> table_of(const Options& o, const Scene& scene,
                               const ground_truth::ReferenceData& reference,
                               const Provenance& provenance) {
  ChartOptions options = o.chart;
  std::optional<ground_truth::ToolReference> whole_tool;
  if (!o.tool_reference.empty()) {
    auto read = ground_truth::read_tool_reference(o.tool_reference);
    if (!read) return read.error();
    whole_tool = std::move(*read);
    options.tool_reference = &*whole_tool;
  }
  const auto rows = measure_chart(scene, reference, options);
  if (!rows) return rows.error();
  // One message instead of a table of failures.
  if (std::ranges::none_of(*rows, &std::string::empty, &ChartRow::failure))
    return Error{rows->front().failure};
  report::Table table("chart");
  for (const ChartRow& row : *rows) table.add(table_row(row, provenance));
  return table;
}

/// Measures and writes it down; the pictures come last.
Result<int> make_chart(const program::Program& program, const Options& o, const Scene& scene) {
  const auto reference = ground_truth::read_reference(o.reference);
  if (!reference) return reference.error();
  const Provenance provenance = provenance_of(scene, o);
  const auto add_peers = [&o](const report::Table& laws) -> Result<report::Table> {
    if (o.peers.empty()) return laws;
    return with_peers(laws, o.peers, hash_of_files({o.reference}));
  };
  // Before the work, which a file that does not fit would make vain.
  if (const auto peers = add_peers(report::Table("chart")); !peers) return peers.error();
  auto table = table_of(o, scene, *reference, provenance);
  if (!table) return table.error();
  table = add_peers(*table);
  if (!table) return table.error();
  auto files = write_chart(*table, program.command(), provenance, o.out);
  if (!files) return files.error();
  if (!o.no_plots) {
    const std::string title =
        fmt::format("{}: speed against accuracy, {}", scene.name, provenance.machine);
    const auto plots = draw_chart(*table, title, o.out);
    if (!plots) return program.fail(plots.error(), "the tables are written, the pictures are not");
    files->insert(files->end(), plots->begin(), plots->end());
  }
  if (o.json) {
    fmt::print("{}", chart_json(*table, program.command(), provenance));
  } else {
    fmt::print("{}", chart_text(*table));
    for (const std::string& file : *files) fmt::print("{}\n", file);
  }
  // tact's own promise: where a peer beats it, the check fails.
  const auto ahead = peers_ahead(*table);
  for (const std::size_t i : ahead)
    fmt::print(stderr,
               "tact-lab chart: the peer {} {} is both faster and nearer than tact's front\n",
               word(table->rows()[i], "family"), word(table->rows()[i], "size"));
  return ahead.empty() ? 0 : 1;
}

Result<int> run(const program::Program& program, Options& o) {
  if (auto error = program::prepare_folder(o.out)) return *error;
  o.chart.request.quick = o.quick;
  if (o.quick) o.chart.timing = {.ticks = 5000, .rounds = 2, .limit_s = 1.0};
  if (o.reference.empty() && o.tool_reference.empty())
    return Error{"no reference given; --reference or --tool-reference is needed"};
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  return o.reference.empty() ? check_whole_tool(program, o, *scene)
                             : make_chart(program, o, *scene);
}

}  // namespace

void add_chart(program::Program& lab) {
  lab.add<Options>(
      "chart", "speed against accuracy of every law of a scene, and of other methods",
      R"(Measures every law of the scene in several sizes: force and shape error against the
reference, time and memory of a tick. --peers shows beside them what was measured before:
finite elements solved every tick, a mesh of springs, Bullet's soft body. Errors are ratios
of the peak force and of the depth, times us, memory bytes. A reference is linear elastic,
so relaxation is off for the errors and on for the times, and compliance.large_strain is
off. The pictures need gnuplot. It fails a check when a peer is ahead of tact's front.
Example: tact-lab chart model/scenes/liver.toml --reference reference.json --out chart)",
      add_options, run);
}

}  // namespace tact::tools::lab
