// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/options.h"

#include <sched.h>

#include <CLI/CLI.hpp>

#include "firmware/console/service_manager.h"
#include "model/io/program/command_line.h"
#include "model/io/program/within.h"

namespace tact::firmware::run {
namespace {

void add_run(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene_path, "scene file (TOML), e.g. model/scenes/liver.toml");
  app.add_option("--set", o.overrides, "KEY=VALUE override of a scene key, may be repeated")
      ->take_all()
      // Otherwise CLI11 would take the next words as further values of this --set.
      ->allow_extra_args(false);
  auto* seconds = app.add_option("--seconds", o.duration_s, "stop after this time, s");
  seconds->check(model::io::within(1e-3, 1e7));
  app.add_option("--ticks", o.ticks, "stop after this many ticks")
      ->check(model::io::within(1, 1e15))
      ->excludes(seconds);
  app.add_flag("--free-run", o.free_run,
               "simulated time, as fast as the CPU allows; needs --ticks or --seconds");
  app.add_flag("--arm", o.arm,
               "hardware: force as soon as the device is ready, without an operator who arms it");
  app.add_option("--json", o.json_path,
                 "write the report to this file when done, - for stdout; with --list-devices, "
                 "--parameters or --faults that list");
}

void add_real_time(CLI::App& app, Options& o) {
  app.add_flag("--strict", o.strict, "refuse to run where the PC gives no hard real time");
  app.add_option("--core", o.core, "CPU core of the loop (default: an isolated one, or the last)")
      ->check(model::io::within(0, CPU_SETSIZE - 1));
  auto* seccomp = app.add_flag("--seccomp", o.seccomp,
                               "refuse to run where the loop's system calls cannot be filtered "
                               "(default: filter if it can be)");
  app.add_flag("--no-seccomp", o.no_seccomp, "let the loop make any system call")
      ->excludes(seccomp);
  app.add_flag("--trust-library", o.trust_library,
               "load the vendor SDK without checking who owns the file");
}

// Recordings of a run, and their replay.
void add_records(CLI::App& app, Options& o) {
  auto* record = app.add_option("--record", o.record_path,
                                "log every tick to this new file; at 4 GB it becomes FILE.old and "
                                "begins again");
  auto* replay =
      app.add_option(
             "--replay", o.replay_path,
             "compute a recorded run again, with its --set values, and compare the forces bit "
             "for bit")
          ->excludes(record);
  app.add_option("--csv", o.csv_path,
                 "with --replay: write every tick of that log or black box to this CSV file; then "
                 "SCENE may be left out")
      ->needs(replay);
  auto* black_box = app.add_option(
      "--black-box", o.black_box_folder,
      "folder for the last 10 s before each fault, one file each, and for the history of this PC, "
      "year.tacthistory (default: tact/black-box in XDG_STATE_HOME, or in ~/.local/state)");
  app.add_flag("--no-black-box", o.no_black_box, "keep no such files")->excludes(black_box);
}

void add_telemetry(CLI::App& app, Options& o) {
  app.add_option("--socket", o.socket_path,
                 "telemetry socket (default: tact/telemetry.sock in XDG_RUNTIME_DIR, or in "
                 "/tmp/tact-UID)");
  app.add_option("--viewers", o.viewers,
                 "group whose members may look at the telemetry, and move the hand of a simulated "
                 "device (default: the same user and root)");
  app.add_flag("--no-telemetry", o.no_telemetry, "open no socket");
}

// Options that print something and start no run.
void add_answers(CLI::App& app, Options& o) {
  auto* check = app.add_flag("--check", o.check, "check scene, meshes, law and device, then leave");
  app.add_flag("--no-device", o.no_device,
               "with --check: hardware is not opened, a simulated delta replaces it")
      ->needs(check);
  app.add_flag("--faults", o.faults, "print every fault with its cause and remedy, then leave");
  app.add_flag("--list-devices", o.list_devices,
               "print what is plugged in, what it lacks and the remedy, then leave");
  app.add_flag("--parameters", o.parameters,
               "print the numbers of the scene's law with their ranges, then leave");
  app.add_flag("--cite", o.cite, "print CITATION.cff with the commit of this build, then leave");
  app.add_flag("--help-scene", o.help_scene, "print every scene key with its range, then leave");
}

/// Contradictions between options.
std::optional<model::Error> contradiction(const Options& o) {
  if (o.scene_path.empty() && !o.faults && !o.help_scene && !o.cite && !o.list_devices &&
      o.csv_path.empty())
    return model::Error{"SCENE is required"};
  // A service starts at boot or after a crash, when no hand holds the tool.
  if (o.arm && console::is_service())
    return model::Error{"--arm: a service never arms; a person does, by tactctl"};
  // Simulated time does not wait: it would run until it is killed.
  if (o.free_run && o.duration_s == 0.0 && o.ticks == 0)
    return model::Error{"--free-run: needs --ticks or --seconds"};
  return std::nullopt;
}

}  // namespace

Parsed parse_options(int argc, char** argv) {
  Parsed parsed;
  Options& o = parsed.options;
  CLI::App app{
      "tactd: the haptic controller. Runs one scene on one device at the scene's fixed rate.\n"
      "Ctrl-C: force to zero, clean exit. Exit status: 0 good, 1 a fault or a difference, 2 bad "
      "usage or input."};
  add_run(app, o);
  add_real_time(app, o);
  add_records(app, o);
  add_telemetry(app, o);
  add_answers(app, o);
  if (const auto status = model::io::parse_command_line(app, "tactd", argc, argv,
                                                        [&o] { return contradiction(o); })) {
    parsed.leave = true;
    parsed.status = *status;
  }
  return parsed;
}

}  // namespace tact::firmware::run
