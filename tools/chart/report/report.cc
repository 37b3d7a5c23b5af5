// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/file_writer.h"
#include "model/io/json.h"

namespace tact::tools::chart {
namespace {

using model::Error;
using model::Result;
using nlohmann::ordered_json;

constexpr const char* kFormat = "tact-chart";
// read_chart() takes this one alone: an older chart has other columns.
constexpr int kVersion = 4;

/// Numbers as Table::to_json writes them: those that are not finite are words.
report::Cell cell_of(const nlohmann::json& value, bool is_word) {
  if (is_word) return value.get<std::string>();
  // Infinity becomes NaN, too: both mean "not measured" to a program that chooses by it.
  return value.is_number() ? value.get<double>() : std::nan("");
}

std::string text_or_dash(double value, double scale, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", scale * value, digits) : "-";
}

}  // namespace

std::string csv_head(const std::string& command, const Provenance& provenance) {
  return fmt::format("# command: {}\n# scene: {}\n# reference: {}\n# revision: {}\n# machine: {}\n",
                     command, provenance.scene_hash, provenance.reference_hash, provenance.revision,
                     provenance.machine);
}

std::string chart_json(const report::Table& table, const std::string& command,
                       const Provenance& provenance) {
  const ordered_json json = *model::io::parse_json<ordered_json>(table.to_json(), "chart");
  return model::io::text_of(ordered_json{{"format", kFormat},
                                         {"version", kVersion},
                                         {"command", command},
                                         {"scene", provenance.scene_hash},
                                         {"reference", provenance.reference_hash},
                                         {"revision", provenance.revision},
                                         {"machine", provenance.machine},
                                         {"rows", json["rows"]}},
                            1) +
         "\n";
}

Result<std::vector<std::string>> write_chart(const report::Table& table, const std::string& command,
                                             const Provenance& provenance,
                                             const std::string& directory) {
  const std::string stem = (std::filesystem::path(directory) / table.name()).string();
  if (auto error =
          model::io::write_file(stem + ".csv", csv_head(command, provenance) + table.to_csv()))
    return *error;
  if (auto error = model::io::write_file(stem + ".json", chart_json(table, command, provenance)))
    return *error;
  return std::vector<std::string>{stem + ".csv", stem + ".json"};
}

Result<report::Table> read_chart(const std::string& path) {
  const auto parsed =
      model::io::read_json(path, "make it: tact-lab chart SCENE --reference FILE --out DIR");
  if (!parsed) return parsed.error();
  try {  // the library reports by exceptions; they end here
    const nlohmann::json& document = *parsed;
    if (document.value("format", "") != kFormat || document.value("version", 0) != kVersion)
      return Error{
          fmt::format("{}: is no chart of this version; make it again: tact-lab chart SCENE "
                      "--reference FILE --out DIR",
                      path)};
    const auto& rows = document.at("rows");
    report::Table table("chart");
    for (const auto& row : rows) {
      report::Row cells = table_row({}, {});
      // By name: the order in the file does not matter.
      for (auto& [column, cell] : cells)
        cell = cell_of(row.at(column), std::holds_alternative<std::string>(cell));
      table.add(std::move(cells));
    }
    return table;
  } catch (const nlohmann::json::exception& e) {
    return Error{fmt::format(
        "{}: {}; make it again: tact-lab chart SCENE --reference FILE --out DIR", path, e.what())};
  }
}

Result<report::Table> with_peers(const report::Table& laws, const std::string& path,
                                 const std::string& reference_hash) {
  const auto peers = read_chart(path);
  if (!peers) return peers.error();
  report::Table out = laws;
  for (const report::Row& row : peers->rows()) {
    if (word(row, "kind") != "peer" || word(row, "reference_hash") != reference_hash)
      return Error{
          fmt::format("{}: the row {} {} is no peer that was measured against this --reference; "
                      "leave out --peers",
                      path, word(row, "family"), word(row, "size"))};
    out.add(row);
  }
  return out;
}

std::string source_of_peers(const report::Table& table) {
  for (const report::Row& row : table.rows())
    if (word(row, "kind") == "peer")
      return fmt::format("peers: measured before, by revision {}, on {}", word(row, "revision"),
                         word(row, "machine"));
  return {};
}

namespace {

constexpr char kLine[] =
    "{:<40} {:>8} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8} {:>9} {:>9} {:>8} {:>9}\n";

std::string row_text(const report::Row& row, bool on_front) {
  const bool is_peer = word(row, "kind") == "peer";
  const std::string name = fmt::format("{}{} {}",
                                       is_peer    ? "peer "
                                       : on_front ? "* "
                                                  : "  ",
                                       word(row, "family"), word(row, "size"));
  if (word(row, "failure") != "-")
    return fmt::format("{:<40} not measured: {}\n", name, word(row, "failure"));
  const double instructions = number(row, "instructions");
  return fmt::format(kLine, name, text_or_dash(number(row, "force_rms_ratio"), 100.0, 2),
                     text_or_dash(number(row, "force_worst_ratio"), 100.0, 2),
                     text_or_dash(number(row, "held_out_rms_ratio"), 100.0, 2),
                     text_or_dash(number(row, "own_worst_1mm_ratio"), 100.0, 1),
                     text_or_dash(number(row, "own_worst_2mm_ratio"), 100.0, 1),
                     text_or_dash(number(row, "own_worst_5mm_ratio"), 100.0, 1),
                     text_or_dash(number(row, "own_worst_10mm_ratio"), 100.0, 1),
                     text_or_dash(number(row, "within_jnd_ratio"), 100.0, 0) + " %",
                     text_or_dash(number(row, "shape_rms_ratio"), 100.0, 2),
                     text_or_dash(number(row, "tool_rms_ratio"), 100.0, 2),
                     text_or_dash(number(row, "tick_median_us"), 1.0, 3),
                     text_or_dash(number(row, "tick_p999_us"), 1.0, 3),
                     std::isfinite(instructions) ? fmt::format("{:.0f}", instructions) : "n/a",
                     text_or_dash(number(row, "memory_bytes"), 1e-3, 1));
}

}  // namespace

std::string chart_text(const report::Table& table) {
  std::string out = fmt::format(kLine, "law and size", "force %", "worst %", "held o %", "1 mm",
                                "2 mm", "5 mm", "10 mm", "in JND", "shape %", "tool %", "median us",
                                "p99.9 us", "instr.", "memory kB");
  const auto front = front_rows(table);
  for (std::size_t i = 0; i < table.rows().size(); ++i) {
    const bool on_front = std::find(front.begin(), front.end(), i) != front.end();
    out += row_text(table.rows()[i], on_front);
  }
  if (const std::string peers = source_of_peers(table); !peers.empty()) out += peers + "\n";
  return out +
         "* on the front of tact: no other law is both faster and nearer to the reference.\n"
         "The reference is linear: compliance is checked with large_strain off.\n"
         "force, worst: one sphere, of the peak; 1 mm and so on: of the own force at the worst "
         "site.\n"
         "tool: the whole tool, RMS of the peak. Time of a law: detect, render, limit of the whole "
         "tool;\nof a peer: its own answer to one sphere.\n"
         "instr. n/a: too many to step through, and this processor lets no user count.\n";
}

}  // namespace tact::tools::chart
