// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/run_plan.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "firmware/console/operator_view.h"
#include "firmware/gate/gate.h"
#include "firmware/gate/limits_for.h"
#include "firmware/run/loop_parts.h"
#include "firmware/watch/call_filter.h"
#include "firmware/watch/runaway.h"
#include "hal/gpio/gpio_lines.h"
#include "hal/lines_settings.h"
#include "tools/limits/real_device/guarded_play.h"
#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::limits {
namespace {

using model::Error;
using model::Result;

/// The cases of which `why` says nothing; the others go into the report with their reason.
template <class Why>
std::vector<Case> possible(const std::vector<Case>& asked, const Why& why, LimitsReport& report) {
  std::vector<Case> cases;
  for (const Case& c : asked)
    if (const char* reason = why(c))
      report.not_run.push_back({.name = c.name, .why = reason});
    else
      cases.push_back(c);
  return cases;
}

Runs prepare(const std::vector<Case>& cases, const LimitsBench& bench) {
  Runs runs;
  for (const Case& c : cases)
    runs.push_back(
        std::make_unique<CaseRun>(at_rate(c, bench.period_s(), bench.hard_real_time), bench));
  return runs;
}

LimitsReport begin_report(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  LimitsReport report;
  report.started = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  report.scene_name = scene.name;
  report.scene_path = scene.path;
  report.scene_limits = scene.limits;
  report.device_name = device.name;
  report.simulated = hal::registry::is_simulated(scene.device);
  report.period_s = 1.0 / scene.rate_Hz;
  report.environment = firmware::pc::read_environment(scene.hash);
  return report;
}

/// What the guards found: it has no case of its own.
void report_fault(Fault found, const hal::Device& device, const hal::SafetyLines& lines) {
  const model::FaultEntry& fault = model::describe(found);
  const std::string detail = firmware::console::fault_detail_of(found, device, lines);
  fmt::print(stderr, "tact-limits: the plan ended with {}: {}{}{}; {}\n", fault.name, fault.cause,
             detail.empty() ? "" : ": ", detail, fault.remedy);
}

/// Names the cases of the whole plan that are not to be played, as they were not asked for.
void name_the_rest(LimitsReport& report, const PlanOptions& options) {
  for (const Case& c : all_cases()) {
    const auto same = [&](const Case& asked) { return std::string_view(asked.name) == c.name; };
    if (std::none_of(options.cases.begin(), options.cases.end(), same))
      report.not_run.push_back({.name = c.name, .why = "not asked for"});
  }
  if (!options.wall)
    report.not_run.push_back({.name = std::string(kWallName), .why = "not asked for"});
}

Result<LimitsReport> finished(LimitsReport report, const Runs& runs, const LimitsBench& bench,
                              const hal::DeviceInfo& device, bool wall) {
  if (program::is_interrupted()) return program::interruption();
  report.limits = checked_limits(Case{}, bench);
  report.pc_limits = report.limits;
  report.force_share = bench.force_share;
  report.hard_real_time = bench.hard_real_time;
  for (const auto& run : runs)
    report.cases.push_back({.verdict = check_case(*run), .rows = run->rows()});
  if (wall) {
    report.wall = measure_wall(bench, device);
    if (!report.wall) return program::interruption();
  }
  return report;
}

/// As tactd decides: a PC that lacks anything gets the quarter of the force.
bool gives_hard_real_time(std::vector<firmware::pc::Shortfall> shortfalls) {
  for (auto& limited : firmware::watch::lift_time_limits())
    shortfalls.push_back(std::move(limited));
  return shortfalls.empty() && firmware::pc::probe_rt_threads({}).empty();
}

Result<LimitsReport> run_simulated(const model::scene::Scene& scene, const hal::DeviceInfo& info,
                                   const PlanOptions& options) {
  const LimitsBench bench{.scene = scene,
                          .limits = firmware::gate::limits_for(scene.limits, info),
                          .gate_limits = options.gate_limits};
  // As the loop's thread does: else the last digits of a fading force would differ from tactd's.
  firmware::pc::flush_denormals();
  LimitsReport report = begin_report(scene, info);
  // Where no force may reach the fingers the case of the fingers would show nothing.
  const auto why = [&bench](const Case& c) {
    return c.grip == Grip::kJaws && !(bench.limits.grip_force_N > 0.0) ? kNoGripForce : nullptr;
  };
  const Runs runs = prepare(possible(options.cases, why, report), bench);
  for (const auto& run : runs)
    if (!run->play()) break;
  name_the_rest(report, options);
  auto done = finished(std::move(report), runs, bench, info, options.wall);
  if (!done) return done;
  // Simulated time needs none, but the tactd of this scene will.
  std::vector<firmware::pc::Shortfall> shortfalls;
  firmware::pc::use_small_thread_stacks();
  const firmware::pc::ProcessSetup setup(shortfalls);
  const double share = gives_hard_real_time(shortfalls) ? 1.0 : firmware::gate::kNonRtForceShare;
  done->pc_limits = model::limits_in_use(done->limits, share);
  return done;
}

Result<LimitsReport> run_real(const model::scene::Scene& scene, hal::Device& device,
                              const PlanOptions& options) {
  auto lines = hal::gpio::open_safety_lines(scene.device.of<hal::LinesSettings>());
  if (!lines) return Error{fmt::format("{}: {}", scene.path, lines.error().message)};
  std::vector<firmware::pc::Shortfall> shortfalls;
  firmware::pc::use_small_thread_stacks();
  const firmware::pc::ProcessSetup setup(shortfalls);
  const bool hard = gives_hard_real_time(shortfalls);
  const hal::DeviceInfo info = device.info();
  // Before the first tick: should this program die, another process has to zero the force.
  const auto guardian = firmware::run::start_guardian(device, {.priority = 1, .program = {}});
  if (!guardian) return guardian.error();
  firmware::loop::Requests requests;
  const LimitsBench bench{.scene = scene,
                          .limits = firmware::gate::limits_for(scene.limits, info),
                          .force_share = hard ? 1.0 : firmware::gate::kNonRtForceShare,
                          .hard_real_time = hard,
                          .device = &device,
                          .lines = lines->get(),
                          .requests = &requests,
                          .guardian = guardian->get(),
                          .gate_limits = options.gate_limits};
  LimitsReport report = begin_report(scene, info);
  const auto why = [&scene](const Case& c) {
    return why_left_out(c, scene.device.of<hal::LinesSettings>());
  };
  const std::vector<Case> cases = possible(options.cases, why, report);
  if (options.wall) report.not_run.push_back({.name = std::string(kWallName), .why = kNeedsHand});
  name_the_rest(report, options);
  const Runs runs = prepare(cases, bench);
  const auto filter =
      firmware::watch::CallFilter::make(device.loop_calls(), (*lines)->loop_calls(), requests);
  // A kernel without it is no reason not to test; the report says so.
  if (!filter) fmt::print(stderr, "tact-limits: {}\n", filter.error().message);
  report.call_filter =
      play_guarded(runs, bench, filter ? filter->get() : nullptr, options.progress).call_filter;
  if (const Fault found = requests.fault.load(); found != Fault::kNone)
    report_fault(found, device, **lines);
  (*lines)->stop();
  return finished(std::move(report), runs, bench, info, false);
}

}  // namespace

const char* why_left_out(const Case& c, const hal::LinesSettings& lines) {
  // A person cannot be asked to pull a device by so many m/s in a given tick.
  if (c.hand != HandMove::kStill || c.grip == Grip::kJaws) return kNeedsHand;
  const bool has_estop = lines.wired() && (lines.estop_a >= 0 || lines.estop_b >= 0);
  if (c.injected == InjectedFault::kEmergencyStop && !has_estop)
    return "no emergency stop is wired";
  if (c.injected == InjectedFault::kDeadMan && !(lines.wired() && lines.dead_man >= 0))
    return "no dead-man switch is wired";
  return nullptr;
}

Result<LimitsReport> run_plan(const model::scene::Scene& scene, const PlanOptions& options) {
  auto device = hal::registry::open_device(scene);
  if (!device) return device.error();
  if (hal::registry::is_simulated(scene.device))
    return run_simulated(scene, (*device)->info(), options);
  return run_real(scene, **device, options);
}

}  // namespace tact::tools::limits
