// SPDX-License-Identifier: Apache-2.0
// tact-lab fit: which numbers let a law of the scene follow measured forces, and how nearly.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/io/program/within.h"
#include "tools/fit/fit_csv.h"
#include "tools/fit/fit_report.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"
#include "tools/program/run_program.h"
#include "tools/program/sweep.h"

namespace tact::tools::lab {
namespace {

using namespace fit;
using model::Error;
using model::Result;
using model::scene::Scene;

struct Options {
  program::SceneArguments scene;
  std::string data, relaxation, reference, out, plot;
  std::vector<std::string> held_out, keep, laws{"all"};
  BenchColumns columns;
  FitOptions fit;
  std::size_t terms = 0;
  bool large_strain = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app, "the laws to fit");
  app.add_option(
         "--law", o.laws,
         "which laws, by the name in a scene, or disc_stack_linear, disc_stack_almen_laszlo")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--reference", o.reference,
                 "JSON of tact-lab reference; its held-out sites check the fit");
  app.add_option("--data", o.data, "CSV of a bench: depth_m,force_N[,site][,u_0_m,...]");
  app.add_option("--relaxation", o.relaxation, "CSV of a bench at held depth: time_s,force_N");
  app.add_option("--keep", o.keep, "keys of the law that stay as the scene has them")
      ->delimiter(',');
  app.add_option("--held-out", o.held_out,
                 "sites that only check the fit, besides those of the scene")
      ->delimiter(',');
  app.add_option("--depth-column", o.columns.depth, "name in --data")->capture_default_str();
  app.add_option("--force-column", o.columns.force, "name in both CSVs")->capture_default_str();
  app.add_option("--time-column", o.columns.time, "name in --relaxation")->capture_default_str();
  app.add_option("--depth-unit-m", o.columns.depth_unit_m, "m in one unit; 0.001 for mm")
      ->check(model::io::above_zero());
  app.add_option("--force-unit-N", o.columns.force_unit_N, "N in one unit; 0.001 for mN")
      ->check(model::io::above_zero());
  app.add_option("--time-unit-s", o.columns.time_unit_s, "s in one unit")
      ->check(model::io::above_zero());
  app.add_option("--deepest-m", o.columns.deepest_m, "deeper rows of --data are left out")
      ->check(model::io::above_zero());
  app.add_option("--shape-weight", o.fit.shape_weight,
                 "what an error of the shape (of the depth) counts against one of the force (of "
                 "the peak); 0: forces alone")
      ->check(model::io::within(0.0, 1e12))
      ->capture_default_str();
  app.add_flag("--scale-by-site", o.fit.scale_by_site, "each site has its own factor of the force");
  app.add_flag("--large-strain", o.large_strain, "the reference's cases with large strain");
  app.add_option("--terms", o.terms, "of --relaxation (default: the fewest with RMS below 2 %)")
      ->check(model::io::within(1, 3));
  app.add_option("--out", o.out, "TOML to write: sections to paste into the scene");
  app.add_option("--picture", o.plot, "SVG to draw (and PNG), with gnuplot");
  app.add_flag("--json", o.json, "print one JSON object, SI units");
}

Result<FitData> read_data(const Options& o, const Scene& scene) {
  if (!o.reference.empty()) {
    const auto reference = ground_truth::read_reference(o.reference);
    if (!reference) return reference.error();
    return fit_data_of(*reference, scene, o.held_out, o.large_strain);
  }
  auto data = read_bench_csv(o.data, o.columns, o.held_out);
  if (!data) return data;
  // Fewer than ten digits: stoul() below cannot fail.
  for (FitSite& site : data->sites) {  // a site named by a vertex has a place
    const bool is_number =
        !site.name.empty() && site.name.size() < 10 &&
        std::all_of(
            site.name.begin(), site.name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_number) site.at = surface_point_at_vertex(scene.organ_mesh, std::stoul(site.name));
  }
  return data;
}

bool answers_to(const FitLaw& law, const std::string& name) {
  return name == "all" || name == law.name || name == law.law;
}

/// The laws of the scene that --law names, without the parameters that --keep names.
Result<std::vector<FitLaw>> chosen_laws(const Options& o, const Scene& scene, const FitData& data) {
  std::vector<FitLaw> all = fit_laws_of(scene, data), chosen;
  for (const std::string& name : o.laws) {
    bool is_known = false;
    for (const FitLaw& law : all) {
      if (!answers_to(law, name)) continue;
      is_known = true;
      // "disc_stack,disc_stack_linear" names the linear form twice.
      const bool is_new = std::none_of(chosen.begin(), chosen.end(),
                                       [&](const FitLaw& c) { return c.name == law.name; });
      if (is_new) chosen.push_back(law);
    }
    if (!is_known)
      return Error{fmt::format("{} describes no law \"{}\"; write its section or correct --law",
                               scene.path, name)};
  }
  for (const std::string& key : o.keep) {
    std::size_t kept = 0;
    for (FitLaw& law : chosen) kept += keep_parameters(law, {key});
    // A key that is misspelt would be fitted in silence.
    if (kept == 0)
      return Error{fmt::format("--keep {}: no chosen law fits that key; leave it out", key)};
  }
  for (const FitLaw& law : chosen)
    if (law.parameters.empty())
      return Error{fmt::format("--keep leaves nothing of {} to fit; keep fewer keys", law.name)};
  return chosen;
}

std::optional<Error> fit_laws(const Options& o, const Scene& scene, FitReport& report) {
  auto data = read_data(o, scene);
  if (!data) return data.error();
  report.data = std::move(*data);
  const auto laws = chosen_laws(o, scene, *report.data);
  if (!laws) return laws.error();
  std::vector<std::optional<Result<FittedLaw>>> fitted(laws->size());
  const bool whole = program::run_jobs(laws->size(), {.label = "tact-lab fit"}, [&](std::size_t i) {
    fitted[i] = fit_law((*laws)[i], scene, *report.data, o.fit);
  });
  if (!whole) return program::interruption();
  for (std::size_t i = 0; i < laws->size(); ++i)
    if (*fitted[i])
      report.laws.push_back(std::move(**fitted[i]));
    else
      // One law that cannot be made must not cost the others.
      report.notes.push_back((*laws)[i].name + " was not fitted: " + fitted[i]->error().message);
  if (report.laws.empty()) return Error{report.notes.front()};
  return std::nullopt;
}

std::optional<Error> fit_relaxation(const Options& o, FitReport& report) {
  const auto held = read_relaxation_csv(o.relaxation, o.columns);
  if (!held) return held.error();
  auto fit = fit_prony(*held, {.terms = o.terms});
  if (!fit) return Error{o.relaxation + ": " + fit.error().message};
  report.relaxation = std::move(*fit);
  return std::nullopt;
}

/// What must be right before minutes of work.
std::optional<Error> check_options(const Options& o) {
  if (o.data.empty() && o.reference.empty() && o.relaxation.empty())
    return Error{"nothing to fit to; give --reference, --data or --relaxation"};
  if (!o.data.empty() && !o.reference.empty())
    return Error{"--data and --reference exclude each other; fit one after the other"};
  for (const auto& [output, beginning] :
       // Files of ours may be overwritten: by their beginnings they are known.
       {std::pair{o.out, "# By tact-lab fit"}, std::pair{o.plot, "<?xml version=\"1.0\""}})
    if (auto error = program::check_output(output, beginning,
                                           {o.scene.path, o.data, o.relaxation, o.reference}))
      return error;
  return std::nullopt;
}

Result<int> run(const program::Program&, Options& o) {
  if (auto error = check_options(o)) return *error;
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  FitReport report;
  if (!o.data.empty() || !o.reference.empty())
    if (auto error = fit_laws(o, *scene, report)) return *error;
  if (!o.relaxation.empty())
    if (auto error = fit_relaxation(o, report)) return *error;
  report.sort();
  if (!o.out.empty())
    if (auto error = model::io::write_file(o.out, toml_of(report))) return *error;
  return finish(o.plot.empty() ? Result<nlohmann::json>(nlohmann::json::object())
                               : picture_of(report, o.plot),
                o.json ? model::io::text_of(json_of(report), 2) + "\n" : text_of(report),
                report.follows() ? 0 : 1);
}

}  // namespace

void add_fit(program::Program& lab) {
  lab.add<Options>(
      "fit", "the numbers of the laws from measured or solved forces",
      R"(Fits the laws of a scene to measured forces (and shapes), says how far each stays off,
and prints the keys to paste into the scene. Residuals are root mean squares over all
samples, in % of the largest force; a law whose RMS stays above 7 %, the least difference
of force that people feel, or whose worst sample is off by more than 7 % of the force there
(7 mN below 0.1 N), cannot follow: a failed check if none can.
Example: tact-lab fit model/scenes/liver.toml --data press.csv --law rhombus --out keys.toml)",
      add_options, run);
}

}  // namespace tact::tools::lab
