// SPDX-License-Identifier: Apache-2.0
// tact-jitter: latency and jitter of the loop that a person runs, and of each of its phases.
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/io/program/installed.h"
#include "model/io/program/within.h"
#include "model/scene/scene.h"
#include "tools/jitter/report/jitter_report.h"
#include "tools/jitter/run/load.h"
#include "tools/jitter/trace/tick_trace.h"
#include "tools/program/run_program.h"
#include "tools/program/script.h"
#include "tools/report/head.h"

namespace {

using namespace tact::tools;
using namespace tact::tools::jitter;
using nlohmann::json;
using tact::model::Error;

struct Options {
  JitterOptions run;
  std::string out, json_path, peer, submit;
  bool no_plots = false;
};

// NOLINTNEXTLINE(readability-function-size): a table of options
void add_run_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.run.scene.path, "scene file (TOML) whose loop and device are measured");
  app.add_option("--set", o.run.scene.overrides, "one key of the scene, as KEY=VALUE; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--bare", o.run.bare,
               "no scene: an empty loop, what the kernel alone gives; so it is without SCENE");
  app.add_option("--duration", o.run.duration_s, "of the loop, s")
      ->check(tact::model::io::within(0.1, 1e7))
      ->capture_default_str();
  app.add_option("--rate", o.run.rate_Hz, "ticks per second, Hz (default: the scene's, or 1000)")
      ->check(tact::model::io::within(tact::model::scene::kRate_Hz.low,
                                      tact::model::scene::kRate_Hz.high));
  app.add_option("--core", o.run.core,
                 "CPU core of the loop (default: an isolated one, or the last)")
      ->check(tact::model::io::within(0, CPU_SETSIZE - 1));
  app.add_option("--load", o.run.load,
                 "beside the loop, by stress-ng: cpu,memory,disk,net or fewer")
      ->delimiter(',')
      ->check(CLI::IsMember(load_kinds()));
  auto* peer =
      app.add_option("--peer", o.peer, "cyclictest: takes turns with the loop, on its core")
          ->check(CLI::IsMember({"cyclictest"}));
  app.add_option("--peer-gate", o.run.peer_gate,
                 "fail if wake-up p99.9 over the peer's is more in the median of the turns, as a "
                 "ratio; takes three turns, 15 s")
      ->check(tact::model::io::within(0.01, 100.0))
      ->needs(peer);
  app.add_option("--threshold", o.run.threshold_us,
                 "from deadline to force, us: ticks above are listed with what the kernel counted, "
                 "and marked in ftrace where it may be written (default: a tenth of the period)")
      ->check(tact::model::io::within(1.0, 1e6));
  app.add_flag("--stop-trace", o.run.stop_trace, "the first of them ends the recording of ftrace");
  auto* back = app.add_option("--loop-back", o.run.loop_back,
                              "input line of device.lines.chip that the scope pin is wired to: "
                              "input to force is measured at the pin");
  app.add_option("--scope-pin", o.run.scope_pin,
                 "output line of that chip (default: device.lines.scope of the scene)")
      ->check(tact::model::io::within(0, 1023))
      ->needs(back->check(tact::model::io::within(0, 1023)));
  app.add_flag("--trust-library", o.run.scene.trust_library,
               "load the vendor SDK without checking who owns the file");
  app.add_flag("--arm", o.run.arm, "hardware: with force; without it the force is always zero");
  app.add_option("--out", o.out,
                 "folder for jitter.json, report.html, histogram.svg and .csv, and "
                 "ticks.trace.json for ui.perfetto.dev; made if need be");
  app.add_flag("--no-pictures", o.no_plots, "no histogram; needs no gnuplot");
  app.add_option("--json", o.json_path, "write the result to this file too, - for stdout alone");
  app.add_option("--submit", o.submit,
                 "write a row of the table of PCs to this file, to send it; a row that is "
                 "there is replaced");
}

/// To the file, or to standard output; nothing without a path.
std::optional<Error> write_json(const json& result, const std::string& path) {
  // Words of the kernel and of the machine may hold any byte: a wrong one is replaced.
  const std::string text = tact::model::io::text_of(result, 2) + "\n";
  if (path == "-") fmt::print("{}", text);
  if (path.empty() || path == "-") return std::nullopt;
  return tact::model::io::write_file(path, text);
}

std::optional<Error> write_folder(const JitterResult& result, const std::string& folder,
                                  const std::string& command) {
  if (auto error = write_json(to_json(result, command), folder + "/jitter.json")) return error;
  return tact::model::io::write_file(
      folder + "/ticks.trace.json",
      make_tick_trace(result.sink->kept_ticks(), boottime_offset_ns()));
}

int measure(const program::Program& program, Options& o) {
  if (o.run.bare && !o.run.scene.path.empty())
    return program.fail(Error{"name one SCENE, or --bare for an empty loop; see --help"});
  o.run.bare = o.run.scene.path.empty();
  if (!o.out.empty())
    // Outputs are checked before a measurement that may take hours.
    if (auto error = program::prepare_folder(o.out)) return program.fail(*error);
  if (o.json_path != "-")
    if (auto error = program::check_output(o.json_path, "{", {o.run.scene.path}))
      return program.fail(*error);
  if (!o.submit.empty())
    if (auto error = program::check_output(o.submit, submission_beginning(), {}))
      return program.fail(*error);
  o.run.peer = !o.peer.empty();
  // The line overwrites itself: in a file it would be thousands.
  o.run.live = isatty(STDERR_FILENO) != 0;
  const std::string began_utc = report::now_utc();
  auto result = run_jitter(o.run);
  if (!result) return program.fail(result.error());
  result->began_utc = began_utc;
  result->host = report::host_name();
  // A reader of JSON on standard output must get nothing else.
  if (o.json_path != "-") fmt::print("{}\n", make_summary(*result));
  if (auto error = write_json(o.json_path.empty() ? json() : to_json(*result, program.command()),
                              o.json_path))
    return program.fail(*error);
  if (!o.submit.empty())
    if (auto error = tact::model::io::write_file(o.submit, make_submission(*result)))
      return program.fail(*error);
  if (!o.out.empty())
    if (auto error = write_folder(*result, o.out, program.command()))
      return program.fail(*error, "its files are not complete");
  const auto verdict = check_peer(*result);
  if (!result->interrupted && verdict && !verdict->passed())
    fmt::print(stderr, "tact-jitter: {}\n", verdict->message());
  const int status =
      result->interrupted
          ? program.fail(program::interruption(),
                         "what was measured until then is reported, without a picture")
          : exit_status(*result);
  if (o.out.empty()) return status;
  std::vector<std::string> arguments{"--status", std::to_string(status)};
  if (o.no_plots || result->interrupted) arguments.emplace_back("--no-pictures");
  arguments.insert(arguments.end(), {"--", o.out});
  return program.fail(
      program::become_script("report/jitter_page.py", std::move(arguments), "tact-tools"),
      "the page is not written");
}

}  // namespace

int main(int argc, char** argv) {
  program::Program program(
      "tact-jitter",
      "Is this PC good enough for the rate? Latency and jitter of the loop that a person runs: the "
      "scene's law\non its device, phase by phase; without SCENE an empty loop at 1 kHz. "
      "`tact-jitter compare A B`\nputs two results side by side, `tact-jitter history` shows days, "
      "weeks and a year of tactd,\n`tact-jitter late` names who made a tick of tactd late.",
      "Times are us on screen and ns in files. \"largest\" is that of the run and bounds nothing.");
  Options options;
  CLI::App& app = program.options();
  add_run_options(app, options);
  // Scripts, beside this program or in share/tact.
  for (const std::string name : {"compare", "history", "late"})
    if (argc > 1 && name == argv[1])
      execv(tact::model::io::data_file("tact-jitter-" + name).c_str(), argv + 1);
  if (const auto status = program.parse(argc, argv)) return *status;
  return measure(program, options);
}
