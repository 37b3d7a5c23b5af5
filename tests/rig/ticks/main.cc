// SPDX-License-Identifier: Apache-2.0
// tact-rig-ticks: what a tick log says about a fault: when it was seen, when the force was zero,
// what moved afterwards.
//
// Times are CLOCK_MONOTONIC, ns, of a tick's wake-up; the force it decides is written within the
// same tick. "Zero" is the first tick after the fault from which on every written force and torque
// is 0, so a force that comes back shows as a late zero and as moved_after_N.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/loop/supervisor.h"
#include "firmware/protocol/tick_log.h"

namespace tact::rig {
namespace {

using firmware::protocol::LoggedTick;
using nlohmann::json;

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

// What a script adds to its own wall clock to get the loop's clock.
void print_clock_offset() { fmt::print("{}\n", now_ns(CLOCK_MONOTONIC) - now_ns(CLOCK_REALTIME)); }

std::int64_t woke_ns(const LoggedTick& tick) {
  return tick.due_ns + tick.phase_ns[static_cast<std::size_t>(firmware::loop::Phase::kWake)];
}
double force_N(const LoggedTick& tick) { return norm(tick.output.written.force_N); }
bool pushes(const LoggedTick& tick) {
  return force_N(tick) != 0.0 || norm(tick.output.written.torque_Nm) != 0.0;
}

/// The ticks of one run, with the fault at `injected_ns` (0: none) in view.
class FaultStory {
 public:
  explicit FaultStory(std::int64_t injected_ns) : injected_ns_(injected_ns) {}

  void add(const LoggedTick& tick) {
    ++ticks_;
    add_pause(tick);
    skipped_ += tick.input.skipped_periods;
    most_skipped_ = std::max(most_skipped_, tick.input.skipped_periods);
    last_ = tick;
    if (tick.input.sample.tool.grip_ratio >= 1.0) {
      ++gripped_;
      most_pull_N_ = std::max(most_pull_N_, -tick.output.written.force_N.z);
    }
    const bool after = injected_ns_ != 0 && woke_ns(tick) >= injected_ns_;
    if (!after) {
      if (pushes(tick)) pushed_before_ = true;
      force_before_N_ = force_N(tick);
      return;
    }
    if (!first_after_) first_after_ = tick;
    if (!detected_ && tick.output.fault != model::Fault::kNone) detected_ = tick;
    if (!missed_ && misses(tick)) missed_ = tick;
    if (pushes(tick)) {
      zero_.reset();
      last_push_ = tick;
    } else if (!zero_) {
      zero_ = tick;
    }
    if (first_zero_) moved_after_N_ = std::max(moved_after_N_, force_N(tick));
    if (!first_zero_ && detected_ && !pushes(tick)) first_zero_ = tick;
    if (detected_ && tick.output.state == firmware::loop::State::kArmed) ++armed_after_;
  }

  json to_json() const {
    json out{{"ticks", ticks_},
             {"skipped", skipped_},
             {"most_skipped_at_once", most_skipped_},
             {"injected_ns", injected_ns_},
             {"force_before_N", force_before_N_},
             {"pushed_before", pushed_before_},
             {"moved_after_N", moved_after_N_},
             {"armed_ticks_after", armed_after_},
             {"gripped_ticks", gripped_},
             {"most_pull_N", most_pull_N_}};
    out["pauses"] = pauses_;
    report(out, "first_tick_after", first_after_);
    report(out, "missed", missed_);
    report(out, "detected", detected_);
    report(out, "zero", zero_);
    if (last_) out["end_state"] = firmware::loop::name_of(last_->output.state);
    if (last_) out["end_fault"] = model::describe(last_->output.fault).name;
    return out;
  }

 private:
  // The limit of a tick is that of the last stage alone: a sample that is missing may be behind it.
  static bool misses(const LoggedTick& tick) {
    return !tick.input.sample.fresh || tick.output.limit == model::Fault::kSampleHeld ||
           tick.output.limit == model::Fault::kSampleStale;
  }

  // The late tick passes the skipped periods to the next one: the force before it, its own, later
  // ones.
  void add_pause(const LoggedTick& tick) {
    if (tick.input.skipped_periods > 0 && last_ && pauses_.size() < kPausesReported)
      pauses_.push_back({{"skipped", tick.input.skipped_periods},
                         {"before_N", before_last_N_},
                         {"after_N", {force_json(*last_)}}});
    if (!pauses_.empty() && pauses_.back()["after_N"].size() < kTicksReported)
      pauses_.back()["after_N"].push_back(force_json(tick));
    if (last_) before_last_N_ = force_json(*last_);
  }
  static json force_json(const LoggedTick& tick) {
    const model::Vec3& force_N = tick.output.written.force_N;
    return {force_N.x, force_N.y, force_N.z};
  }

  void report(json& out, const char* what, const std::optional<LoggedTick>& tick) const {
    if (!tick) {
      out[what] = nullptr;
      return;
    }
    out[what] = {{"tick", tick->tick},
                 {"time_ns", woke_ns(*tick)},
                 {"due_ns", tick->due_ns},
                 {"after_ms", 1e-6 * static_cast<double>(woke_ns(*tick) - injected_ns_)},
                 {"fault", model::describe(tick->output.fault).name},
                 {"limit", model::describe(tick->output.limit).name}};
  }

  static constexpr std::size_t kPausesReported = 8, kTicksReported = 12;

  std::int64_t injected_ns_;
  json pauses_ = json::array();  // the first ones
  json before_last_N_ = json::array({0.0, 0.0, 0.0});
  std::uint64_t ticks_ = 0, skipped_ = 0, armed_after_ = 0, gripped_ = 0;
  std::uint32_t most_skipped_ = 0;
  double force_before_N_ = 0.0, moved_after_N_ = 0.0;
  double most_pull_N_ = 0.0;  // downwards, with closed jaws
  bool pushed_before_ = false;
  std::optional<LoggedTick> first_after_, missed_, detected_, zero_, first_zero_, last_push_, last_;
};

int report_story(const std::string& path, std::int64_t injected_ns) {
  auto log = firmware::protocol::TickLog::open(path);
  if (!log) {
    fmt::print(stderr, "tact-rig-ticks: {}\n", log.error().message);
    return 2;
  }
  FaultStory story(injected_ns);
  for (LoggedTick tick; log->next(tick);) story.add(tick);
  fmt::print("{}\n", story.to_json().dump(2));
  return 0;
}

/// Deadline and wake-up of each tick that woke so much later than its deadline.
int report_late(const std::string& path, double late_us) {
  auto log = firmware::protocol::TickLog::open(path);
  if (!log) return fmt::print(stderr, "tact-rig-ticks: {}\n", log.error().message), 2;
  for (LoggedTick tick; log->next(tick);) {
    const std::int64_t woke = woke_ns(tick);
    if (static_cast<double>(woke - tick.due_ns) > 1e3 * late_us)
      fmt::print("{} {}\n", tick.due_ns, woke);
  }
  return 0;
}

/// A deadline of a loop that still runs: all others lie whole periods from it.
int report_grid(const std::string& path) {
  auto log = firmware::protocol::TickLog::open(path);
  if (LoggedTick tick; log && log->next(tick)) return fmt::print("{}\n", tick.due_ns), 0;
  fmt::print(stderr, "tact-rig-ticks: {}\n", log ? path + " has no tick yet" : log.error().message);
  return 2;
}

}  // namespace
}  // namespace tact::rig

int main(int argc, char** argv) {
  CLI::App app{"tact-rig-ticks: what a tick log says about a fault, as JSON."};
  std::string path;
  std::int64_t injected_ns = 0;
  bool clock_offset = false, grid = false;
  double late_us = 0.0;
  app.add_option("LOG", path, "written by tactd --record");
  app.add_option("--at", injected_ns, "when the fault came, CLOCK_MONOTONIC, ns");
  app.add_flag("--clock-offset", clock_offset, "print CLOCK_MONOTONIC - CLOCK_REALTIME, ns");
  app.add_flag("--grid", grid, "print a deadline of the loop, CLOCK_MONOTONIC, ns");
  app.add_option("--late", late_us, "print deadline and wake-up, ns, of each that woke later, us");
  CLI11_PARSE(app, argc, argv);
  if (clock_offset) {
    tact::rig::print_clock_offset();
    return 0;
  }
  if (path.empty()) {
    fmt::print(stderr, "tact-rig-ticks: name a tick log; see --help\n");
    return 2;
  }
  if (grid) return tact::rig::report_grid(path);
  if (late_us > 0.0) return tact::rig::report_late(path, late_us);
  return tact::rig::report_story(path, injected_ns);
}
