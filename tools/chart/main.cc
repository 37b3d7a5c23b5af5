// SPDX-License-Identifier: Apache-2.0
// tact-chart: speed against accuracy of every law of a scene, beside other ways to do the same.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "firmware/pc/environment.h"
#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/reader/scene_words.h"
#include "tools/chart/compare/chart.h"
#include "tools/chart/report/pictures.h"
#include "tools/chart/report/report.h"
#include "tools/chart/report/tool_report.h"
#include "tools/program/program.h"

namespace {

using namespace tact::tools;
using namespace tact::tools::chart;
using tact::model::Error;
using tact::model::Result;
using tact::model::scene::Scene;

struct Options {
  program::SceneArguments scene;
  program::SweepArguments sweep;
  std::string out, reference, tool_reference, accuracy, peers;
  ChartOptions chart;
  bool json = false;
};

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app);
  app.add_option("--out", o.out, "folder for tables and pictures; made if need be")->required();
  app.add_option("--reference", o.reference,
                 "what is true under one sphere: JSON of tact-reference SCENE --out FILE");
  app.add_option("--tool-reference", o.tool_reference,
                 "what is true under the whole tool, all spheres; JSON of tact-reference SCENE "
                 "--tool --out FILE. Alone: the scene's laws as they are; with --reference: every "
                 "size too");
  app.add_option("--accuracy", o.accuracy,
                 "with it alone: also this file, SCENE.accuracy, which tactd --check tells")
      ->needs("--tool-reference")
      ->excludes("--reference");
  app.add_option("--laws", o.chart.wish.laws, "only these laws")
      ->delimiter(',')
      ->check(CLI::IsMember(all_families()));
  o.sweep.add_to(app, "row", "fewer sizes, fewer ticks");
  app.add_option(
         "--peers", o.peers,
         "show these rows of a chart.json, measured before, beside the laws; the liver's, in "
         "the sources: tools/results/peers.json")
      ->needs("--reference")
      ->excludes("--shard");
  app.add_flag("--json", o.json, "print the table as JSON");
}

/// Of all that were given, in this order.
std::string hash_of_files(std::initializer_list<std::string> paths) {
  tact::model::reader::TextHash hash;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    const auto text = tact::model::io::read_file(path);
    // A file that cannot be read is told by whoever needs it, with its name.
    hash.add(text ? *text : std::string());
  }
  return hash.hex();
}

Provenance provenance_of(const Scene& scene, const Options& o) {
  return {.scene_hash = scene.hash,
          .reference_hash = hash_of_files({o.reference, o.tool_reference}),
          .revision = tact::firmware::pc::read_environment({}).git_revision,
          .machine = tact::model::scene::machine_name()};
}

/// Judges the whole tool, law by law, and writes tool.csv and tool.json.
int judge_whole_tool(const program::Program& program, const Options& o) {
  if (!o.chart.shard.is_whole() || !o.sweep.merge.empty())
    return program.fail(
        Error{"--tool-reference alone takes no --shard and no --merge; leave them out"});
  const auto scene = o.scene.load();
  if (!scene) return program.fail(scene.error());
  const auto reference = ground_truth::read_tool_reference(o.tool_reference);
  if (!reference) return program.fail(reference.error());
  std::vector<ToolRow> rows;
  for (const auto& name : tact::model::scene::kLawNames) {
    const auto& laws = o.chart.wish.laws;
    // Laws without a section of their own would be judged with numbers that nobody wrote.
    if (!scene->describes(name.kind)) continue;
    if (!laws.empty() && std::find(laws.begin(), laws.end(), name.name) == laws.end()) continue;
    auto row = judge_tool(*scene, name.kind, *reference, o.chart.timing);
    if (!row) return program.fail(row.error());
    rows.push_back(std::move(*row));
  }
  if (rows.empty())
    return program.fail(Error{"none of the wanted laws is described; leave out --laws"});
  const Provenance provenance = provenance_of(*scene, o);
  const std::string json = tool_json(rows, *reference, program.command(), provenance);
  if (const auto error = tact::model::io::write_file(
          o.out + "/tool.csv",
          csv_head(program.command(), provenance) + tool_table(rows, *reference).to_csv()))
    return program.fail(*error);
  if (const auto error = tact::model::io::write_file(o.out + "/tool.json", json))
    return program.fail(*error);
  if (!o.accuracy.empty()) {
    const auto accuracy = accuracy_of(*scene, rows, *reference);
    if (!accuracy) return program.fail(accuracy.error());
    const std::string text = tact::model::scene::accuracy_text(*accuracy);
    if (const auto error = tact::model::io::write_file(o.accuracy, text))
      return program.fail(*error);
  }
  fmt::print("{}", o.json ? json : tool_text(rows, *reference));
  return 0;
}

Result<report::Table> table_of(const Options& o, const Scene& scene,
                               const ground_truth::ReferenceData& reference,
                               const Provenance& provenance) {
  const std::size_t all = variants_of(scene, o.chart.wish).size();
  if (!o.sweep.merge.empty()) {
    auto merged = merge_table(empty_chart(all, {}), o.sweep.merge);
    if (!merged) return merged;
    if (auto mixed = check_same_source(*merged, provenance)) return std::move(*mixed);
    return merged;
  }
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
  report::Table table = empty_chart(all, o.chart.shard);
  const auto failed = [](const ChartRow& row) { return !row.failure.empty(); };
  // One sentence instead of a table of failures.
  if (std::all_of(rows->begin(), rows->end(), failed) && o.chart.shard.is_whole())
    return Error{rows->front().failure};
  for (const ChartRow& row : *rows) table.add(table_row(row, provenance));
  return table;
}

/// What was found, on a terminal; the exit status. A part of the rows proves nothing.
int tell(const program::Program& program, const Options& o, const report::Table& table,
         const Provenance& provenance, const std::vector<std::string>& files) {
  const bool is_whole = o.chart.shard.is_whole();
  if (o.json) {
    fmt::print("{}", chart_json(table, program.command(), provenance));
  } else {
    fmt::print("{}", chart_text(table, is_whole));
    for (const std::string& file : files) fmt::print("{}\n", file);
  }
  int status = 0;
  // tact's own promise: where a peer beats it, the check fails.
  for (const std::size_t i : is_whole ? peers_ahead(table) : std::vector<std::size_t>{}) {
    const report::Row& row = table.rows()[i];
    fmt::print(stderr, "tact-chart: the peer {} {} is both faster and nearer than tact's front\n",
               table.word(row, "family"), table.word(row, "size"));
    status = 1;
  }
  return status;
}

/// Measures, or merges what was measured, and writes it down; the pictures come last.
int make_chart(const program::Program& program, const Options& o) {
  const auto scene = o.scene.load();
  if (!scene) return program.fail(scene.error());
  const auto reference = ground_truth::read_reference(o.reference);
  if (!reference) return program.fail(reference.error());
  Provenance provenance = provenance_of(*scene, o);
  const auto add_peers = [&o](const report::Table& laws) -> Result<report::Table> {
    if (o.peers.empty()) return laws;
    return with_peers(laws, o.peers, hash_of_files({o.reference}));
  };
  // Before the work, which a file that does not fit would make vain.
  if (const auto peers = add_peers(empty_chart(0, {})); !peers) return program.fail(peers.error());
  auto table = table_of(o, *scene, *reference, provenance);
  if (!table) return program.fail(table.error());
  if (!o.sweep.merge.empty()) {  // the rows know better where they come from
    provenance.machine = machines_of(*table);
    provenance.revision = table->word(table->rows()[0], "revision");
  }
  table = add_peers(*table);
  if (!table) return program.fail(table.error());
  const bool is_whole = o.chart.shard.is_whole();
  auto files = write_chart(*table, is_whole, program.command(), provenance, o.out);
  if (!files) return program.fail(files.error());
  if (is_whole && !o.sweep.no_pictures) {
    const std::string title =
        fmt::format("{}: speed against accuracy, {}", scene->name, provenance.machine);
    const auto pictures = draw_chart(*table, title, o.out);
    if (!pictures)
      return program.fail(pictures.error(), "the tables are written, the pictures are not");
    files->insert(files->end(), pictures->begin(), pictures->end());
  }
  return tell(program, o, *table, provenance, *files);
}

}  // namespace

int main(int argc, char** argv) {
  program::Program program(
      "tact-chart",
      "Measure every law of the scene in several sizes: force and shape error against\n"
      "the reference, time and memory of a tick. --peers shows beside them what was measured\n"
      "before: finite elements solved every tick, a mesh of springs, Bullet's soft body.",
      "Errors are ratios of the peak force and of the depth, times us, memory bytes. A\n"
      "reference is linear elastic, so relaxation is off for the errors and on for the\n"
      "times, and compliance.large_strain is off. The pictures need gnuplot. It fails a\n"
      "check when a peer is ahead of tact's front.");
  Options o;
  add_options(program.options(), o);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (const auto error = o.sweep.prepare(o.out)) return program.fail(*error);
  o.chart.shard = o.sweep.shard;
  o.chart.wish.quick = o.sweep.quick;
  if (o.sweep.quick) o.chart.timing = {.ticks = 5000, .rounds = 2, .limit_s = 1.0};
  if (o.reference.empty() && o.tool_reference.empty())
    return program.fail(Error{"no reference given; --reference or --tool-reference is needed"});
  if (o.reference.empty()) return judge_whole_tool(program, o);
  return make_chart(program, o);
}
