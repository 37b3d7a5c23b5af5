// tact-reference: what an elastic organ really does under the scene's tool, by finite elements.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "tools/common/program.h"
#include "tools/common/run_program.h"
#include "tools/common/sweep.h"
#include "tools/common/table.h"
#include "tools/reference/reference_plan.h"
#include "tools/reference/self_check.h"

namespace {

using namespace tact::tools;  // NOLINT(google-build-using-namespace): the program of this folder
using tact::model::Error;
using tact::model::Result;

struct Options {
  std::string scene, out, cache = default_cache_directory(), self_check;
  std::vector<std::string> overrides;
  std::vector<std::uint32_t> sites, large_strain_sites;
  std::vector<double> depths_m;
  int level = 2;
  unsigned jobs = 1;
  bool json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("scene", o.scene, "scene file (TOML) with [elastic] and [[reference_site]]");
  app.add_option("--out", o.out, "file to write; without it, a table of forces only");
  app.add_option("--set", o.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_option("--sites", o.sites, "vertices of the organ's mesh, instead of the scene's")
      ->delimiter(',');
  app.add_option("--depths", o.depths_m, "m, above 0, rising, at most 5 tool radii; press and pull")
      ->delimiter(',');
  app.add_option("--large-strain", o.large_strain_sites,
                 "sites also pressed, and pulled up to 1.3 tool radii, with large strain; "
                 "about 25 min each, always on the coarse mesh")
      ->delimiter(',');
  app.add_option("--level", o.level, "mesh, 1 coarse to 4 fine; each about twice the time")
      ->check(CLI::Range(kCoarsestLevel, kFinestLevel))
      ->capture_default_str();
  app.add_option("--cache", o.cache, "folder of solved cases")->capture_default_str();
  app.add_option("--jobs", o.jobs, "solves at a time; each takes a core and about 1 GB")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_flag("--json", o.json, "print the result as JSON");
  app.add_option("--self-check", o.self_check,
                 "instead of a scene: compare with the known answers in this folder "
                 "(tests/data/reference)");
}

Result<ReferencePlan> make_plan(const Options& o) {
  if (o.scene.empty()) return Error{"no scene given; see tact-reference --help"};
  const auto scene = tact::model::load_scene(o.scene, o.overrides);
  if (!scene) return scene.error();
  auto plan = plan_of(*scene);
  if (!plan) return plan;
  if (!o.sites.empty()) plan->sites = o.sites;
  if (!o.depths_m.empty()) plan->depths_m = o.depths_m;
  plan->large_strain_sites = o.large_strain_sites;
  plan->level = o.level;
  if (auto error = check(*plan)) return std::move(*error);
  const double most_m = kLargePull * plan->tool_radius_m;
  if (!plan->large_strain_sites.empty() && plan->depths_m.back() > most_m) {
    fmt::print(stderr,
               "tact-reference: left out: pulls with large strain beyond {:.3g} mm ({:g} tool "
               "radii); no mesh that stands them is fine enough\n",
               most_m * 1e3, kLargePull);
  }
  return plan;
}

using Solved = std::vector<std::optional<ReferenceCase>>;

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
  std::mutex mutex;
  std::optional<Error> first_error;
  const auto work = [&](std::size_t job) {
    {
      const std::lock_guard lock(mutex);
      if (first_error) return;
    }
    auto result = solve_once(organ, cases[job], solver, cache);
    if (result) {
      solved[job] = std::move(*result);
      return;
    }
    const std::lock_guard lock(mutex);
    if (cases[job].large_strain && found_no_solution(result.error())) {
      why_not[job] = result.error().sentence;
    } else if (!first_error) {
      first_error = result.error();
    }
  };
  const bool whole =
      run_jobs(cases.size(), {.label = "tact-reference", .shard = {}, .threads = o.jobs}, work);
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (!why_not[i].empty())
      fmt::print(stderr, "tact-reference: left out: {}: {}\n", name_of(cases[i]), why_not[i]);
  if (first_error) return *first_error;
  if (!whole) return interruption();
  return solved;
}

Result<ReferenceData> solve_plan(const ReferencePlan& plan, const Options& o) {
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

void print_table(const ReferenceData& data) {
  fmt::print("{:>6} {:>9} {:>11} {:>10} {:>11}  {}\n", "vertex", "depth mm", "contact mm",
             "force N", "mesh err %", "material");
  for (const SolvedSite& site : data.sites)
    for (const ReferenceCase& c : site.cases)
      fmt::print("{:>6} {:>9.3g} {:>11.3f} {:>10.5f} {:>11}  {}\n", site.vertex, c.depth_m * 1e3,
                 c.contact_radius_m * 1e3, c.force_N,
                 std::isfinite(c.force_error_ratio)
                     ? fmt::format("{:.2f}", c.force_error_ratio * 100.0)
                     : "-",
                 c.large_strain ? "neo-Hookean" : "linear");
}

}  // namespace

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  Program program(
      "tact-reference", "Solve press and pull of the scene's organ with gmsh and CalculiX.",
      "Needs gmsh and CalculiX: apt install gmsh calculix-ccx. Solved cases are kept and reused.");
  Options options;
  add_options(program.options(), options);
  if (const auto status = program.parse(argc, argv)) return *status;
  const auto fail = [&program](const Error& error) {
    return program.fail(error, "what was solved is kept, the same command goes on from there");
  };
  if (!options.self_check.empty()) {
    const auto good = self_check(options.self_check);
    return good ? (*good ? 0 : 1) : fail(good.error());
  }
  if (auto error = check_output(options.out, {options.scene})) return fail(*error);
  const auto plan = make_plan(options);
  if (!plan) return fail(plan.error());
  const auto data = solve_plan(*plan, options);
  if (!data) return fail(data.error());
  const std::string text = reference_text(*data);
  if (!options.out.empty()) {
    if (const auto written = write_whole_file(options.out, text); !written)
      return fail(written.error());
  }
  if (options.json) {
    fmt::print("{}", text);
  } else {
    print_table(*data);
  }
  return 0;
}
