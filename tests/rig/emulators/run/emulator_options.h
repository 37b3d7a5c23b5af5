// SPDX-License-Identifier: Apache-2.0
// emulator_options.h - the options that both emulators have, and the frame of their run.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tests/rig/emulators/mechanics/platform.h"
#include "tests/rig/emulators/run/fault_plan.h"

namespace tact::rig {

struct EmulatorOptions {
  std::string self_check;  // folder of the published vectors
  int priority = 70;
  double seconds = 0.0;  // 0: until SIGTERM
  std::string record;
  std::vector<std::string> fault_texts;
  std::string clock = "enabled";
  Hand hand{};

  bool faults_start_at_once() const { return clock == "start"; }
  double room_s() const { return seconds > 0.0 ? seconds : 600.0; }
};

void add_options(CLI::App& app, EmulatorOptions& options, FaultSide side);
/// The faults ordered. False: the message with the remedy.
bool parse_faults(const EmulatorOptions& options, FaultSide side, FaultPlan& plan,
                  std::string& error);
/// The answer on stdout and the record, when real time is over. The exit status.
int finish(const std::string& program, const EmulatorOptions& options,
           const class RunRecord& record, const std::string& json);
/// The message on stderr; exit status 2.
int refuse(const std::string& program, const std::string& error);

}  // namespace tact::rig
