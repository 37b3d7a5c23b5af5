// SPDX-License-Identifier: Apache-2.0
// tact-limits: does the force keep its limits, for any command and any fault?
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "hal/lines_settings.h"
#include "hal/registry/open_device.h"
#include "model/io/json.h"
#include "tools/limits/real_device/consent.h"
#include "tools/limits/run_plan.h"
#include "tools/program/program.h"
#include "tools/program/script.h"

namespace {

using namespace tact::tools;
using namespace tact::tools::limits;
using tact::model::Error;
using tact::model::scene::Scene;

struct Options {
  std::string plan = "all", out;
  program::SceneArguments scene;
  Testers people;
  bool list = false, json = false, no_plots = false, consent_from_stdin = false;
};

void add_options(CLI::App& app, Options& o) {
  // Not SceneArguments::add_to: --list needs no scene.
  app.add_option("SCENE,--scene", o.scene.path,
                 "scene file (TOML): its device and its limits are tested");
  app.add_option("--set", o.scene.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_option("--plan", o.plan, "all, or names of cases with commas")->capture_default_str();
  app.add_option("--out", o.out, "folder of the report; made if need be");
  app.add_option("--tester", o.people.tester,
                 "who tests; without it the page has a line to fill in");
  app.add_option("--location", o.people.place, "where");
  app.add_option("--serial", o.people.serials,
                 "serial number of device, PC or tool, with its name; repeatable");
  app.add_option("--report-number", o.people.number,
                 "on every page (default: made of time, limits and host)");
  app.add_flag("--list", o.list, "the cases and what they do, nothing else");
  app.add_flag("--no-pictures", o.no_plots, "tables and page without curves; needs no gnuplot");
  app.add_flag("--consent-from-stdin", o.consent_from_stdin,
               "read the words of consent from a pipe: for a test bench without a person");
  app.add_flag("--trust-library", o.scene.trust_library,
               "load the vendor SDK without checking who owns the file");
  app.add_flag("--json", o.json, "print one JSON document");
}

int list_cases() {
  for (const Case& c : all_cases()) fmt::print("{:16} {}\n", c.name, c.what);
  fmt::print(
      "{:16} {}\n", kWallName,
      "A wall is made stiffer until a motion on it grows, without and with the passivity stage.");
  return 0;
}

/// A real device moves only for a person who has typed that it may.
std::optional<Error> ask_for_consent(const Options& o, const Scene& scene) {
  // A script that feeds the words by accident is no person who has read them.
  if (!o.consent_from_stdin && (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0))
    return Error{
        "drives a real device to its limits, so it asks on a terminal first: start it from one "
        "(--help names the flag for a bench without a person)"};
  const double force_N = scene.limits.force_N;
  fmt::print(
      stderr, "{}Type: {}\n> ",
      warning_text(scene.device.kind, force_N, scene.device.of<tact::hal::LinesSettings>().wired()),
      consent_text(force_N));
  std::fflush(stderr);
  return read_consent(std::cin, force_N);
}

void show_progress(std::size_t done, std::size_t all) {
  fmt::print(stderr, "\r{} of {} cases ", done, all);
  if (done == all) fmt::print(stderr, "\n");
  std::fflush(stderr);
}

int test_limits(const program::Program& program, const Options& o) {
  if (const auto error = check_number(o.people.number)) return program.fail(*error);
  const auto cases = choose_cases(o.plan);
  if (!cases) return program.fail(cases.error());
  const auto scene = o.scene.load(tact::hal::registry::visit_device);
  if (!scene) return program.fail(scene.error());
  // Before the run: a file that changes meanwhile must not get its digest into the report.
  auto evidence = collect_evidence(o.scene.path, o.scene.overrides, o.people);
  if (!evidence) return program.fail(evidence.error());
  if (const auto error = program::prepare_folder(o.out)) return program.fail(*error);
  // Last of all checks: after the words the device moves.
  if (!tact::hal::registry::is_simulated(scene->device))
    if (const auto refused = ask_for_consent(o, *scene)) return program.fail(*refused);
  PlanOptions options{.cases = *cases, .wall = names_wall(o.plan)};
  if (isatty(STDERR_FILENO) != 0) options.progress = show_progress;
  auto report = run_plan(*scene, options);
  if (!report) return program.fail(report.error());
  report->command = program.command();
  close_evidence(*evidence, report->limits);
  report->evidence = std::move(*evidence);
  // Reported below even if it could not be written: a run on a device is not repeated lightly.
  const auto failed = write_report(*report, o.out);
  if (o.json)
    fmt::print("{}\n", tact::model::io::text_of(to_json(*report), 2));
  else
    fmt::print("{}", to_text(*report));
  if (failed) return program.fail(*failed, "the report is not complete");
  if (!o.json) fmt::print("{}: {}/limits.html\n", report->result_text(), o.out);
  std::vector<std::string> arguments{"--status", report->passed() ? "0" : "1"};
  if (o.no_plots) arguments.emplace_back("--no-pictures");
  arguments.insert(arguments.end(), {"--", o.out});
  return program.fail(
      program::become_script("report/limits_page.py", std::move(arguments), "tact-tools"),
      "the page is not written");
}

}  // namespace

int main(int argc, char** argv) {
  program::Program program(
      "tact-limits",
      "Test of safety-limited force output: plays cases to the loop that drives the device, from "
      "a\n"
      "step to a dead emergency stop, and evaluates what the device was handed.",
      "Writes limits.html (the report to hand on), limits.json, cases.csv, a trace of every tick\n"
      "for each case, wall.csv, and curves by gnuplot. Forces N, torques N m, energy J, power W,\n"
      "times s. The simulated device runs on simulated time. A real device runs in real time,\n"
      "after a warning and words that a person types; cases that need the simulated hand, or a\n"
      "safety line that is not wired, are left out there, and the report says so.");
  Options o;
  add_options(program.options(), o);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (o.list) return list_cases();
  if (o.scene.path.empty() || o.out.empty())
    return program.fail({"SCENE and --out DIR are needed; see --help"});
  return test_limits(program, o);
}
