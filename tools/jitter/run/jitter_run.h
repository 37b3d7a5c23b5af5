// SPDX-License-Identifier: Apache-2.0
// jitter_run.h - one measurement: the loop of a scene on its device, or a bare one, with load and
// peer if they are asked for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/pc/environment.h"
#include "firmware/pc/pc_check.h"
#include "firmware/run/thread_costs.h"
#include "model/result.h"
#include "tools/jitter/run/loop_back.h"
#include "tools/jitter/statistics/costs.h"
#include "tools/jitter/statistics/tick_sink.h"
#include "tools/program/program.h"

namespace tact::tools::jitter {

struct JitterOptions {
  program::SceneArguments scene;
  bool bare = false;  // no scene, no device: the kernel alone
  bool arm = false;   // hardware: with force; a simulated device always has it
  int core = -1;
  double duration_s = 10.0;
  double rate_Hz = 0.0;       // 0: the scene's, or 1000 of a bare loop
  double threshold_us = 0.0;  // 0: a tenth of the period
  std::vector<std::string> load;
  bool peer = false;                // cyclictest
  std::optional<double> peer_gate;  // most of the turns' median ratio
  bool stop_trace = false;
  int scope_pin = -1, loop_back = -1;  // lines of device.lines.chip, wired together; -1: none
  bool live = false;                   // a line on the terminal while it runs
};

struct JitterResult {
  std::string host, began_utc;
  std::string subject;     // "liver on simulated delta ..., law ..." or "bare loop"
  std::string scene_hash;  // empty for a bare loop
  double rate_Hz = 0.0;
  double measured_s = 0.0;  // of the loop's own slices
  int core = 0, priority = 0;
  bool armed = false;
  bool interrupted = false;  // by Ctrl-C
  bool non_rt = false;
  std::vector<firmware::pc::Shortfall> shortfalls;
  std::string load;  // "cpu,memory"; empty: none
  std::unique_ptr<TickSink> sink;
  firmware::run::ThreadCosts thread;
  Costs costs;
  bool has_marker = false;  // late ticks are marked in the kernel's trace
  std::optional<Series> peer;
  std::vector<double>
      turn_ratios;  // wake-up p99.9 over the peer's, of each turn with enough samples
  std::optional<double> peer_gate;  // most of their median
  std::optional<PulseMeter> pin;    // input to force, at the scope pin
  std::string fault;                // name and cause; empty: none
  std::vector<firmware::pc::PcRow> pc;
  firmware::pc::Environment environment;
};

/// Runs it. Ctrl-C ends the loop early, with zero force; what was measured until then is kept.
model::Result<JitterResult> run_jitter(const JitterOptions& options);

/// How the run is cut where a peer takes turns: at least two slices of at most 5 s. A device that
/// is hardware runs in one piece, as its own watchdog would meet the pauses.
std::vector<double> slices_of(double duration_s, bool takes_turns);

}  // namespace tact::tools::jitter
