// SPDX-License-Identifier: Apache-2.0
#include "tools/sweep/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/io/json.h"

namespace tact::tools::sweep {
namespace {

using model::scene::PressPoint;
using model::scene::PressResult;
using model::scene::PressState;
using model::scene::PressSweep;
using model::scene::PressWay;

const char* word_of(PressWay way) { return way == PressWay::kSquare ? "square" : "upright"; }

const char* word_of(PressState state) {
  switch (state) {
    case PressState::kPressed:
      return "pressed";
    case PressState::kMissed:
      return "missed";
    case PressState::kBlocked:
      return "blocked";
  }
  return "?";
}

/// "changes+draws_in", or "none"
std::string flaw_text(const PressResult& result, const PressSweep& sweep) {
  const auto flaws = flaws_of(result, sweep.settings);
  std::string out;
  const auto add = [&out](bool holds, const char* word) {
    if (holds) out += (out.empty() ? "" : "+") + std::string(word);
  };
  add(flaws.changes_too_fast, "changes");
  add(flaws.draws_in, "draws_in");
  add(flaws.is_too_stiff, "too_stiff");
  add(flaws.is_not_rendered, "unfelt");
  add(flaws.energy_differs, "energy");
  return out.empty() ? "none" : out;
}

nlohmann::json to_json(const PressResult& r) {
  return {{"vertex", r.place.vertex},
          {"way", word_of(r.place.way)},
          {"slope_N_per_m", r.slope_N_per_m.value},
          {"depth_m", r.slope_N_per_m.depth_m}};
}

}  // namespace

report::Table presses_table(const model::scene::Scene& scene, const PressSweep& sweep) {
  report::Table table("presses");
  for (const PressResult& r : sweep.results) {
    const model::Vec3& at_m = scene.organ_mesh.vertex_m[r.place.vertex];
    table.add({{"vertex", r.place.vertex},
               {"way", word_of(r.place.way)},
               {"x_m", at_m.x},
               {"y_m", at_m.y},
               {"z_m", at_m.z},
               {"state", word_of(r.state)},
               {"flaws", flaw_text(r, sweep)},
               {"deepest_m", r.deepest_m},
               {"force_N", r.force_N},
               {"slope_N_per_m", r.slope_N_per_m.value},
               {"slope_at_m", r.slope_N_per_m.depth_m},
               {"change_N", r.change_N.value},
               {"change_at_m", r.change_N.depth_m},
               {"least_N", r.least_N.value},
               {"least_at_m", r.least_N.depth_m},
               {"energy_ratio", r.energy_ratio.value},
               {"energy_at_m", r.energy_ratio.depth_m}});
  }
  return table;
}

nlohmann::json presses_picture(const PressSweep& sweep, const std::string& folder) {
  constexpr std::size_t kBins = 40;
  const PressResult* stiffest = sweep.stiffest();
  const bool has_slope = stiffest && stiffest->slope_N_per_m.value > 0.0;
  const double most_N_per_m = has_slope ? stiffest->slope_N_per_m.value : 1.0;
  std::array<std::size_t, kBins + 1> count{};
  for (const PressResult& r : sweep.results)
    if (r.state == PressState::kPressed)
      ++count[static_cast<std::size_t>(kBins * r.slope_N_per_m.value / most_N_per_m)];
  return {{"label", "tact-lab sweep"},
          {"folder", folder},
          {"name", "presses"},
          {"script", "presses.gp"},
          {"variables",
           {{"width_px", 1400},
            {"height_px", 700},
            {"bin_N_per_m", most_N_per_m / kBins},
            {"largest_N_per_m", most_N_per_m},
            {"most", *std::ranges::max_element(count)}}}};
}

std::string command_to_repeat(const std::string& command, const PressPoint& place) {
  return fmt::format("{} --vertex {} --{}", command, place.vertex, word_of(place.way));
}

std::string text_of(const PressSweep& sweep, const std::string& command, std::size_t worst) {
  const auto& s = sweep.settings;
  std::string out = fmt::format(
      "{} presses of {:g} mm in steps of {:g} mm, limit of the device {:.4g} N/m: {} pressed, {} "
      "passed the organ, {} could not start: another part of the tool is in the organ\n",
      sweep.results.size(), 1e3 * s.depth_m, 1e3 * s.step_m, s.limit_N_per_m,
      sweep.count(PressState::kPressed), sweep.count(PressState::kMissed),
      sweep.count(PressState::kBlocked));
  if (const PressResult* most = sweep.stiffest())
    out +=
        fmt::format("largest slope  {:.4g} N/m at {}, {:.2f} mm deep\n", most->slope_N_per_m.value,
                    name_of(most->place), 1e3 * most->slope_N_per_m.depth_m);
  out += s.checks_energy ? "energy         checked without friction and relaxation\n"
                         : "energy         not checked: the law is stepped\n";
  const auto flawed = sweep.flawed();
  out += fmt::format("failed         {} presses\n", flawed.size());
  for (std::size_t i = 0; i < std::min(worst, flawed.size()); ++i)
    out += fmt::format("  {}: {}\n    {}\n", name_of(flawed[i]->place),
                       describe_flaws(*flawed[i], s), command_to_repeat(command, flawed[i]->place));
  if (flawed.size() > worst)
    out += fmt::format("  and {} more, in presses.csv\n", flawed.size() - worst);
  return out;
}

std::string json_of(const model::scene::Scene& scene, const PressSweep& sweep,
                    const std::string& command, const std::vector<std::string>& files) {
  const auto& s = sweep.settings;
  nlohmann::json flawed = nlohmann::json::array();
  for (const PressResult* r : sweep.flawed())
    flawed.push_back({{"vertex", r->place.vertex},
                      {"way", word_of(r->place.way)},
                      {"sentence", describe_flaws(*r, s)},
                      {"command", command_to_repeat(command, r->place)}});
  const PressResult* stiffest = sweep.stiffest();
  const nlohmann::json out{{"format", "tact-sweep"},
                           {"version", 1},
                           {"scene", scene.path},
                           {"law", scene.law},
                           {"limit_N_per_m", s.limit_N_per_m},
                           {"step_m", s.step_m},
                           {"depth_m", s.depth_m},
                           {"energy_checked", s.checks_energy},
                           {"pressed", sweep.count(PressState::kPressed)},
                           {"missed", sweep.count(PressState::kMissed)},
                           {"blocked", sweep.count(PressState::kBlocked)},
                           {"stiffest", stiffest ? to_json(*stiffest) : nlohmann::json(nullptr)},
                           {"flawed", std::move(flawed)},
                           {"files", files}};
  return model::io::text_of(out, 2);
}

}  // namespace tact::tools::sweep
