// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/run/emulator_options.h"

#include <cstdio>

#include "tests/rig/emulators/run/real_time.h"
#include "tests/rig/emulators/run/run_record.h"

namespace tact::rig {

void add_options(CLI::App& app, EmulatorOptions& options, FaultSide side) {
  app.add_option(
      "--self-check", options.self_check,
      "Replay the published vectors of this folder through the own codec and kinematics, "
      "and exit: 0 equal, 1 different");
  app.add_option("--priority", options.priority, "SCHED_FIFO priority; 0: as it is")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "End after this time; 0: at SIGTERM")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--record", options.record,
                 "CSV every ms: time_ns, position (m), force on the hand (N), torques (N m)");
  app.add_option("--fault", options.fault_texts,
                 "KIND[:NUMBER]@SECONDS[+DURATION_MS], repeatable; NUMBER is the axis 1..3, of "
                 "no-reply ms. Kinds: " +
                     fault_names(side))
      ->allow_extra_args(false);
  app.add_option(
         "--clock", options.clock,
         "Seconds of faults count from the start of the program, or from when the device is "
         "first enabled, as the hand's path does")
      ->check(CLI::IsMember({"start", "enabled"}))
      ->capture_default_str();
  app.add_option("--hand-top", options.hand.top_m, "Height at which the hand rests, m, W")
      ->check(CLI::Range(-0.1, 0.1))
      ->capture_default_str();
  app.add_option("--hand-tempo", options.hand.tempo, "The hand's path so many times faster")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  app.add_option("--hand-bottom", options.hand.bottom_m, "Height to which it goes down, m, W")
      ->check(CLI::Range(-0.1, 0.1))
      ->capture_default_str();
}

bool parse_faults(const EmulatorOptions& options, FaultSide side, FaultPlan& plan,
                  std::string& error) {
  std::vector<Fault> faults;
  for (const std::string& text : options.fault_texts) {
    Fault fault;
    if (!parse_fault(text, side, fault, error)) return false;
    faults.push_back(fault);
  }
  plan = FaultPlan(std::move(faults));
  return true;
}

int finish(const std::string& program, const EmulatorOptions& options, const RunRecord& record,
           const std::string& json) {
  leave_real_time();
  std::puts(json.c_str());
  if (!options.record.empty() && !record.write_csv(options.record))
    return refuse(program, options.record + " cannot be written: is its folder there?");
  return 0;
}

int refuse(const std::string& program, const std::string& error) {
  std::fprintf(stderr, "%s: %s\n", program.c_str(), error.c_str());
  return 2;
}

}  // namespace tact::rig
