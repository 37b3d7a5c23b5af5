// report.h - what a run tells when it ends: a JSON file for machines, a few lines for people.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "firmware/environment.h"
#include "firmware/law_check.h"
#include "firmware/loop_parts.h"
#include "firmware/rt_loop.h"
#include "firmware/rt_setup.h"
#include "hal/device.h"

namespace tact::firmware {

struct RunFacts {
  std::string scene_name, law_title, device_name;
  double rate_Hz = 0.0;
  double duration_s = 0.0;
  double force_limit_N = 0.0;
  bool non_rt = false;
  bool simulated_time = false;  // durations mean nothing
  std::vector<Shortfall> shortfalls;
  ThreadCosts costs;
  std::vector<hal::DeviceCount> device_counts;
  std::uint64_t dropped_records = 0, dropped_frames = 0;
  State state = State::kOff;
  Fault fault = Fault::kNone;
  std::string trouble;           // what the device says of it
  std::uint64_t force_hash = 0;  // equal for equal runs; 0 when not computed
  long resident_peak_kB = 0;
  std::size_t law_table_bytes = 0;
  bool call_filter = false;              // on the loop's thread
  std::vector<std::string> black_boxes;  // files that this run left
};

nlohmann::json to_json(const Environment& environment);
nlohmann::json to_json(const ThreadCosts& costs);
nlohmann::json make_report(const RunFacts& facts, const LoopStatistics& loop, const Gate& gate,
                           const Environment& environment);
std::string make_summary(const RunFacts& facts, const LoopStatistics& loop);
/// What --check found; without a time where none was measured.
std::string make_check_line(const model::Scene& scene, const std::string& device_name,
                            const model::TissueLaw& law, const StiffnessMargin& stiffness,
                            const std::optional<TimeMargin>& time);

}  // namespace tact::firmware
