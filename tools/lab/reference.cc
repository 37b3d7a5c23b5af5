// SPDX-License-Identifier: Apache-2.0
// tact-lab reference: what an elastic organ does under the scene's tool, by finite elements.
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/io/file_writer.h"
#include "model/io/program/within.h"
#include "tools/lab/commands.h"
#include "tools/program/run_program.h"
#include "tools/program/sweep.h"
#include "tools/reference/plan/reference_plan.h"
#include "tools/reference/plan/sideways_plan.h"
#include "tools/reference/plan/tool_plan.h"
#include "tools/reference/self_check/self_check.h"

namespace tact::tools::lab {
namespace {

using namespace reference;
using model::Error;
using model::Result;

struct Options {
  program::SceneArguments scene;
  std::string out, cache = default_cache_directory(), self_check;
  std::vector<std::uint32_t> sites, large_strain_sites;
  std::vector<double> depths_m;
  int level = 2;
  unsigned jobs = 1;
  bool tool = false, skin = false, sideways = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene.path, "scene file (TOML) with [elastic] and [[reference_site]]");
  app.add_option("--out", o.out, "file to write; without it, a table of forces only");
  app.add_option("--set", o.scene.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_flag(
      "--tool", o.tool,
      "press all spheres of the tool together, at the hand's own site, along its slides and "
      "at six places that no law is fitted on (README.md says how they are chosen)");
  app.add_flag("--skin", o.skin, "with --tool: also how far the skin around it goes")
      ->needs("--tool");
  app.add_flag("--sideways", o.sideways, "drag a round patch along the surface of each site")
      ->excludes("--tool");
  app.add_option("--sites", o.sites,
                 "vertices of the organ's mesh, instead of the scene's or of the six")
      ->delimiter(',');
  app.add_option("--depths", o.depths_m, "m, above 0, rising, at most 5 tool radii; press and pull")
      ->check(model::io::above_zero())
      ->delimiter(',');
  app.add_option("--large-strain", o.large_strain_sites,
                 "sites also pressed, and pulled up to 1.3 tool radii, with large strain; "
                 "about 25 min each, always on the coarse mesh")
      ->delimiter(',')
      ->excludes("--tool");
  app.add_option("--level", o.level, "mesh, 1 coarse to 4 fine; each about twice the time")
      ->check(model::io::within(kCoarsestLevel, kFinestLevel))
      ->capture_default_str();
  app.add_option("--cache", o.cache, "folder of solved cases")->capture_default_str();
  app.add_option("--jobs", o.jobs, "solves at a time; each takes a core and about 1 GB")
      ->check(model::io::within(1, 256))
      ->capture_default_str();
  app.add_flag("--json", o.json, "print the result as JSON");
  app.add_option("--self-check", o.self_check,
                 "instead of a scene: compare with the known answers in this folder "
                 "(tests/data/reference)");
}

const Error kNoScene{"no scene given; see tact-lab reference --help"};

Result<ReferencePlan> make_plan(const Options& o) {
  if (o.scene.path.empty()) return kNoScene;
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  auto plan = plan_of(*scene);
  if (!plan) return plan;
  if (!o.sites.empty()) plan->sites = o.sites;
  if (!o.depths_m.empty()) plan->depths_m = o.depths_m;
  plan->large_strain_sites = o.large_strain_sites;
  plan->level = o.level;
  if (auto error = check(*plan)) return std::move(*error);
  const double most_m = kLargePull * plan->tool_radius_m;
  // Told, not refused: the rest of the plan is worth its hours.
  if (!plan->large_strain_sites.empty() && plan->depths_m.back() > most_m) {
    fmt::print(stderr,
               "tact-lab reference: left out: pulls with large strain beyond {:.3g} mm ({:g} tool "
               "radii); no mesh that stands them is fine enough\n",
               most_m * 1e3, kLargePull);
  }
  return plan;
}

program::SweepOptions sweep_options(const Options& o) {
  return {.label = "tact-lab reference", .threads = o.jobs};
}

/// All places, in the order of presses_of; stops at the first error.
Result<ground_truth::ToolReference> solve_tool(const Options& o) {
  if (o.scene.path.empty()) return kNoScene;
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  auto plan = tool_plan_of(*scene, o.sites, o.depths_m, o.level);
  if (!plan) return plan.error();
  if (o.skin) ask_for_skin(*plan);
  const auto gmsh = ground_truth::gmsh_version();
  if (!gmsh) return gmsh.error();
  const std::string solver = fmt::format("tact, gmsh {}", *gmsh);
  const std::vector<ToolPress> presses = presses_of(*plan);
  const SolveCache cache(o.cache);
  std::vector<std::vector<ground_truth::ToolCase>> solved(presses.size());
  // Each job has a place of its own in `solved`.
  const auto work = [&](std::size_t job) -> std::optional<Error> {
    auto result = solve_once(plan->organ, presses[job], solver, cache);
    if (!result) return result.error();
    solved[job] = std::move(*result);
    return std::nullopt;
  };
  if (auto error = program::run_until_error(presses.size(), sweep_options(o), work))
    return std::move(*error);
  return assemble(*plan, solved, solver);
}

using Solved = std::vector<std::optional<ground_truth::ReferenceCase>>;

/// "vertex 12, press of 10 mm with large strain"
std::string name_of(const Indentation& what) {
  return fmt::format("vertex {}, {} of {:g} mm{}", what.vertex, what.depth_m > 0 ? "press" : "pull",
                     std::abs(what.depth_m) * 1e3, what.large_strain ? " with large strain" : "");
}

/// In their order; stops at the first error. At large strain some depths have no solution: such a
/// case is left out, and told.
Result<Solved> solve_all(const Organ& organ, const std::vector<Indentation>& cases,
                         const std::string& solver, const Options& o) {
  const SolveCache cache(o.cache);
  Solved solved(cases.size());
  std::vector<std::string> why_not(cases.size());
  // Each job has a place of its own in `solved` and `why_not`.
  const auto work = [&](std::size_t job) -> std::optional<Error> {
    auto result = solve_once(organ, cases[job], solver, cache);
    if (!result) {
      if (!cases[job].large_strain || !found_no_solution(result.error())) return result.error();
      // No mesh stands every pull: that is an answer, no failure of the run.
      why_not[job] = result.error().message;
      return std::nullopt;
    }
    solved[job] = std::move(*result);
    return std::nullopt;
  };
  auto error = program::run_until_error(cases.size(), sweep_options(o), work);
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (!why_not[i].empty())
      fmt::print(stderr, "tact-lab reference: left out: {}: {}\n", name_of(cases[i]), why_not[i]);
  if (error) return std::move(*error);
  return solved;
}

Result<ground_truth::ReferenceData> solve_plan(const ReferencePlan& plan, const Options& o) {
  const auto solver = solver_versions();
  if (!solver) return solver.error();
  // First what all presses of a site need, so that no two of them solve it at the same time.
  std::vector<Indentation> probes;
  for (const std::uint32_t vertex : plan.sites)
    probes.push_back(probe_of(vertex, plan.tool_radius_m));
  const auto probed = solve_all(plan.organ, probes, *solver, o);
  if (!probed) return probed.error();
  const auto solved = solve_all(plan.organ, cases_of(plan), *solver, o);
  if (!solved) return solved.error();
  return assemble(plan, *solved, *solver);
}

Result<SidewaysReference> solve_sideways(const Options& o) {
  const auto plan = make_plan(o);
  if (!plan) return plan.error();
  const auto solver = solver_versions();
  if (!solver) return solver.error();
  const auto solved = solve_all(plan->organ, sideways_cases(*plan), *solver, o);
  if (!solved) return solved.error();
  return assemble_sideways(*plan, *solved, *solver);
}

void print_table(const SidewaysReference& data) {
  fmt::print("{:>6} {:>9} {:>6} {:>8} {:>11}\n", "vertex", "radius mm", "held", "N/m",
             "mesh err %");
  for (const SidewaysCase& c : data.cases)
    fmt::print("{:>6} {:>9.3g} {:>6} {:>8.2f} {:>11.2f}\n", c.vertex, c.contact_radius_m * 1e3,
               c.held ? "yes" : "no", c.stiffness_N_per_m, 100.0 * c.error_ratio);
}

void print_table(const ground_truth::ReferenceData& data) {
  fmt::print("{:>6} {:>9} {:>11} {:>10} {:>11}  {}\n", "vertex", "depth mm", "contact mm",
             "force N", "mesh err %", "material");
  for (const ground_truth::SolvedSite& site : data.sites)
    for (const ground_truth::ReferenceCase& c : site.cases)
      fmt::print("{:>6} {:>9.3g} {:>11.3f} {:>10.5f} {:>11}  {}\n", site.vertex, c.depth_m * 1e3,
                 c.contact_radius_m * 1e3, c.force_N,
                 std::isfinite(c.force_error_ratio)
                     ? fmt::format("{:.2f}", c.force_error_ratio * 100.0)
                     : "-",
                 c.large_strain ? "neo-Hookean" : "linear");
}

void print_table(const ground_truth::ToolReference& data) {
  fmt::print("{:>9} {:>9} {:>10} {:>11}  {}\n", "place", "depth mm", "force N", "mesh err %",
             "of each sphere N");
  for (const ground_truth::ToolPoint& place : data.places)
    for (const ground_truth::ToolCase& c : place.cases)
      fmt::print("{:>9} {:>9.3g} {:>10.5f} {:>11.2f}  {:.5f}\n", name_of(place), c.depth_m * 1e3,
                 c.force_N, c.force_error_ratio * 100.0, fmt::join(c.sphere_N, " "));
}

/// Writes and prints what was solved; the exit status.
template <typename Data>
Result<int> report(const program::Program& program, const Options& o, const Result<Data>& data,
                   std::string (*text_of)(const Data&)) {
  if (!data)
    return program.fail(data.error(),
                        "what was solved is kept, the same command goes on from there");
  const std::string text = text_of(*data);
  if (!o.out.empty()) {
    if (const auto error = model::io::write_file(o.out, text)) return *error;
  }
  if (o.json)
    fmt::print("{}", text);
  else
    print_table(*data);
  return 0;
}

Result<int> run(const program::Program& program, Options& o) {
  if (!o.self_check.empty()) {
    const auto good = self_check(o.self_check);
    if (!good) return good.error();
    return *good ? 0 : 1;
  }
  // Before hours of work.
  if (auto error = program::check_output(o.out, "{", {o.scene.path})) return *error;
  if (o.tool) return report(program, o, solve_tool(o), ground_truth::tool_reference_text);
  if (o.sideways) return report(program, o, solve_sideways(o), sideways_text);
  const auto plan = make_plan(o);
  if (!plan) return plan.error();
  return report(program, o, solve_plan(*plan, o), ground_truth::reference_text);
}

}  // namespace

void add_reference(program::Program& lab) {
  lab.add<Options>(
      "reference", "the true force and shape of a pressed elastic organ, by finite elements",
      R"(Solves press and pull of the scene's organ. Needs gmsh, and CalculiX but for --tool,
which tact solves itself: apt install gmsh calculix-ccx. Solved cases are kept and
reused.
Example: tact-lab reference model/scenes/liver.toml --out liver.json --jobs 2)",
      add_options, run);
}

}  // namespace tact::tools::lab
