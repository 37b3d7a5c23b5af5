// SPDX-License-Identifier: Apache-2.0
// options.h - the command line of tactd.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tact::firmware::run {

struct Options {
  std::string scene_path;
  std::vector<std::string> overrides;  // key=value
  double duration_s = 0.0;             // 0: until Ctrl-C
  std::uint64_t ticks = 0;             // 0: no limit
  std::string json_path;               // "-" is standard output
  std::string record_path, replay_path, csv_path;
  std::string socket_path;  // empty: in the runtime directory
  std::string viewers;      // group that may read telemetry; empty: only the same user and root
  bool check = false;       // load everything, then exit
  bool no_device = false;   // check without the hardware of the scene
  bool arm = false;         // hardware: force as soon as the device is ready
  bool strict = false;      // refuse to run without hard real time
  bool free_run = false;    // simulated time, as fast as the CPU allows
  bool no_telemetry = false;
  bool faults = false;      // print the fault table
  bool help_scene = false;  // print every scene key
  bool list_devices = false;
  bool cite = false;             // print how to cite this build
  bool parameters = false;       // print the numbers of the scene's law
  std::string black_box_folder;  // empty: below the user's state folder
  bool no_black_box = false;
  bool seccomp = false;     // refuse to run without the call filter
  bool no_seccomp = false;  // run without it
  bool trust_library = false;
  int core = -1;
  bool has_json_file() const { return !json_path.empty() && json_path != "-"; }
};

/// Result of parse_options: run, or exit with this status (after --help or a usage error).
struct Parsed {
  Options options;
  bool leave = false;
  int status = 0;
};
Parsed parse_options(int argc, char** argv);

}  // namespace tact::firmware::run
