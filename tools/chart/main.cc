// tact-chart: speed against accuracy of every law of a scene, and of other ways to do the same.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "firmware/environment.h"
#include "model/scene.h"
#include "model/scene_words.h"
#include "tools/chart/chart.h"
#include "tools/chart/pictures.h"
#include "tools/chart/report.h"
#include "tools/common/interrupt.h"
#include "tools/common/run_program.h"

namespace {

using namespace tact::tools;  // NOLINT(google-build-using-namespace): the program of this folder
using tact::model::Error;
using tact::model::Result;
using tact::model::Scene;

struct Options {
  std::string scene, out, reference, shard;
  std::vector<std::string> overrides, merge;
  ChartOptions chart;
  bool no_peers = false, no_pictures = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene, "scene file (TOML)")->required();
  app.add_option("--out", o.out, "folder for tables and pictures; made if need be")->required();
  app.add_option("--reference", o.reference,
                 "what is true: JSON of tact-reference SCENE --out FILE")
      ->required();
  app.add_option("--set", o.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_option("--laws", o.chart.wish.laws, "only these laws and peers")
      ->delimiter(',')
      ->check(CLI::IsMember(all_families()));
  app.add_option("--shard", o.shard, "i/n: every n-th row from i on, 0 <= i < n");
  app.add_option("--merge", o.merge, "CSVs of all shards: the table of one whole run");
  app.add_flag("--quick", o.chart.wish.quick, "fewer sizes, no peers, fewer ticks");
  app.add_flag("--no-peers", o.no_peers, "laws of tact alone");
  app.add_flag("--no-pictures", o.no_pictures, "tables alone; needs no gnuplot");
  app.add_flag("--json", o.json, "print the table as JSON");
  app.footer(
      "Errors are ratios of the peak force and of the depth, times us, memory bytes. A reference "
      "is\n"
      "linear elastic, so relaxation is off for the errors and on for the times. The peer fem "
      "needs\n"
      "gmsh, the pictures gnuplot.\n"
      "Exit status: 0 done, 1 a peer is ahead of tact's front or Ctrl-C, 2 bad usage or input.");
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("tact-chart: {}; see tact-chart --help\n", e.what());
  });
}

int fail(const Error& error) {
  const bool interrupted = was_interrupted(error);
  fmt::print(stderr, "tact-chart: {}\n",
             interrupted ? "interrupted; nothing was written" : error.sentence);
  return interrupted ? 1 : 2;
}

std::string hash_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  tact::model::TextHash hash;
  hash.add(std::string{std::istreambuf_iterator<char>(file), {}});
  return hash.hex();
}

Result<Table> table_of(const Options& o, const Scene& scene, const ReferenceData& reference,
                       const Provenance& provenance) {
  const std::size_t all = variants_of(scene, o.chart.wish).size();
  if (!o.merge.empty()) {
    auto merged = merge_table(empty_chart(all, {}), o.merge);
    if (!merged) return merged;
    if (auto mixed = check_same_source(*merged, provenance)) return std::move(*mixed);
    return merged;
  }
  const auto rows = measure_chart(scene, reference, o.chart);
  if (!rows) return rows.error();
  Table table = empty_chart(all, o.chart.shard);
  const auto failed = [](const ChartRow& row) { return !row.failure.empty(); };
  if (std::all_of(rows->begin(), rows->end(), failed) && o.chart.shard.is_whole())
    return Error{rows->front().failure};
  for (const ChartRow& row : *rows) table.add(table_row(row, provenance));
  return table;
}

/// What was found, on a terminal; the exit status.
int tell(const Options& o, const Table& table, const std::vector<std::string>& files) {
  if (o.json) {
    fmt::print("{}", table.to_json());
  } else {
    fmt::print("{}", chart_text(table));
    for (const std::string& file : files) fmt::print("{}\n", file);
  }
  int status = 0;
  for (const std::size_t i : peers_ahead(table)) {
    const Row& row = table.rows()[i];
    fmt::print(stderr, "tact-chart: the peer {} {} is both faster and nearer than tact's front\n",
               table.word(row, "family"), table.word(row, "size"));
    status = 1;
  }
  return status;
}

}  // namespace

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  CLI::App app{
      "Measure every law of the scene in several sizes: force and shape error against the\n"
      "reference, time and memory of a tick; and, on the same mesh, finite elements solved every\n"
      "tick, a whole mesh of springs, and Bullet's soft body."};
  Options o;
  add_options(app, o);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (!o.shard.empty()) {
    const auto shard = parse_shard(o.shard);
    if (!shard) return fail(shard.error());
    o.chart.shard = *shard;
  }
  o.chart.wish.peers = !o.no_peers && !o.chart.wish.quick;
  if (o.chart.wish.quick) o.chart.timing = {.ticks = 5000, .rounds = 2, .limit_s = 1.0};
  const InterruptWatch watch;
  const auto scene = tact::model::load_scene(o.scene, o.overrides);
  if (!scene) return fail(scene.error());
  const auto reference = read_reference(o.reference);
  if (!reference) return fail(reference.error());
  Provenance provenance{.scene_hash = scene->hash,
                        .reference_hash = hash_of_file(o.reference),
                        .revision = tact::firmware::read_environment({}).git_revision,
                        .machine = tact::model::machine_name()};
  const auto table = table_of(o, *scene, *reference, provenance);
  if (!table) return fail(table.error());
  if (!o.merge.empty()) provenance.machine = machines_of(*table);
  std::error_code ignored;
  std::filesystem::create_directories(o.out, ignored);
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i > 0 ? " " : "") + std::string(argv[i]);
  const bool is_whole = o.chart.shard.is_whole();
  auto files = write_chart(*table, is_whole, command, provenance, o.out);
  if (!files) return fail(files.error());
  if (is_whole && !o.no_pictures) {
    const std::string title =
        fmt::format("{}: speed against accuracy, {}", scene->name, provenance.machine);
    const auto pictures = draw_chart(*table, title, o.out);
    if (!pictures) return fail(pictures.error());
    files->insert(files->end(), pictures->begin(), pictures->end());
  }
  return tell(o, *table, *files);
}
