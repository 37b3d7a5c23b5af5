// SPDX-License-Identifier: Apache-2.0
#include "tools/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tact::tools::plan {
namespace {

using model::Error;

/// Names in a table hold no comma or quote.
std::string as_word(std::string text) {
  std::replace_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '"'; }, ';');
  return text;
}

}  // namespace

std::vector<Candidate> candidates_of(const report::Table& table) {
  std::vector<Candidate> out;
  for (const report::Row& row : table.rows()) {
    // Peers of a chart are measured for comparison; tactd has none of them.
    if (word(row, "kind") != "tact" || word(row, "failure") != "-") continue;
    const auto count = [&](const std::string& column) {
      return static_cast<std::size_t>(number(row, column));
    };
    model::scene::LawSizes sizes{.law = word(row, "family"), .table_knots = count("table_knots")};
    sizes.size = count("size_count");
    if (word(row, "form") != "-") sizes.disc_form = word(row, "form");
    // A chart made without --tool-reference has no numbers of the whole tool.
    const bool whole_tool = std::isfinite(number(row, "tool_rms_ratio"));
    out.push_back(
        {.sizes = sizes,
         .force_error_ratio = number(row, whole_tool ? "tool_rms_ratio" : "force_rms_ratio"),
         .own_error_ratio =
             whole_tool ? std::optional(number(row, "tool_own_worst_ratio")) : std::nullopt,
         .shape_error_ratio = number(row, "shape_rms_ratio"),
         .tick_median_us = number(row, "tick_median_us"),
         .tick_p999_us = number(row, "tick_p999_us"),
         .memory_bytes = number(row, "memory_bytes")});
  }
  return out;
}

void keep_what_cuts(std::vector<Candidate>& candidates) {
  std::erase_if(candidates, [](const Candidate& c) { return c.sizes.law != "spring_patch"; });
}

std::optional<Error> check_chart_fits(const report::Table& table, const model::scene::Scene& scene,
                                      const std::string& path) {
  const std::string machine = as_word(model::scene::machine_name());
  for (const report::Row& row : table.rows()) {
    // Peers are not chosen, and were measured elsewhere.
    if (word(row, "kind") == "peer") continue;
    // Before the machine: a changed scene is the likelier slip, and its remedy the same.
    if (word(row, "scene_hash") != scene.hash)
      return Error{fmt::format(
          "{}: the chart of another scene, or of this one before a change; chart it again: "
          "tact-lab chart {} --reference FILE --out DIR",
          path, scene.path)};
    if (word(row, "machine") != machine)
      return Error{
          fmt::format("{}: measured on another machine, {}; chart it here: tact-lab chart {} "
                      "--reference FILE --out DIR",
                      path, word(row, "machine"), scene.path)};
  }
  return std::nullopt;
}

}  // namespace tact::tools::plan
