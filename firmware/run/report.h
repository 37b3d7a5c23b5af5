// SPDX-License-Identifier: Apache-2.0
// report.h - the report at the end of a run: a JSON file for programs, a few lines for people.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/environment.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/run/thread_costs.h"
#include "hal/device.h"

namespace tact::firmware::run {

struct RunFacts {
  std::string scene_name, law_title, device_name;
  double rate_Hz = 0.0;
  double duration_s = 0.0;
  double force_limit_N = 0.0;
  std::string limits_checksum;  // of the limits in use
  bool non_rt = false;
  bool simulated_time = false;  // durations are meaningless
  std::vector<pc::Shortfall> shortfalls;
  ThreadCosts costs;
  std::vector<hal::DeviceCount> device_counts;
  std::uint64_t dropped_records = 0, dropped_frames = 0;
  loop::State state = loop::State::kOff;
  model::Fault fault = model::Fault::kNone;
  std::string fault_detail;            // detail of the fault, from the device or the lines
  std::uint32_t refused_requests = 0;  // requests to arm or reset
  std::uint32_t variants = 0;          // changes of the law's numbers, by tactctl set
  std::uint64_t force_hash = 0;        // equal for equal runs; 0 when not computed
  long resident_peak_kB = 0;
  std::size_t law_table_bytes = 0;
  bool call_filter = false;              // on the loop's thread
  std::vector<std::string> black_boxes;  // files written by this run
};

nlohmann::json to_json(const pc::Environment& environment);
nlohmann::json to_json(const ThreadCosts& costs);
/// As JSON.
std::string make_report(const RunFacts& facts, const loop::LoopStatistics& loop,
                        const gate::Gate& gate, const pc::Environment& environment);
std::string make_summary(const RunFacts& facts, const loop::LoopStatistics& loop);

}  // namespace tact::firmware::run
