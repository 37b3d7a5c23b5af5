// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::firmware::run {
namespace {

using nlohmann::json;

/// With the tick of the maximum, to find it in a tick log.
json percentiles(const loop::LatencyHistogram& h) {
  return {{"count", h.count()},
          {"p50_ns", h.percentile_ns(0.50)},
          {"p99_ns", h.percentile_ns(0.99)},
          {"p99.9_ns", h.percentile_ns(0.999)},
          {"p99.99_ns", h.percentile_ns(0.9999)},
          {"max_ns", h.max_ns()},
          {"max_tick", h.max_tick()}};
}

/// RT-17: each phase separately, because a punctual wake-up does not show a slow bus.
json phases(const loop::LoopStatistics& loop) {
  json all;
  for (std::size_t i = 0; i < loop::kPhaseCount; ++i)
    all[loop::kPhaseName[i]] = percentiles(loop.phase[i]);
  return all;
}

json stages(const gate::Gate& gate) {
  json all;
  for (std::size_t i = 0; i < gate::kStageCount; ++i) all[gate::kStageName[i]] = gate.counters()[i];
  return all;
}

json fault_entry(const RunFacts& facts) {
  const model::FaultEntry& fault = model::describe(facts.fault);
  return {{"number", static_cast<int>(facts.fault)},
          {"name", fault.name},
          {"cause", fault.cause},
          {"trouble", facts.fault_detail},
          {"remedy", fault.remedy}};
}

std::string duration_line(const char* what, const loop::LatencyHistogram& h) {
  const auto us = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-3; };
  return fmt::format("  {:13} p50 {:.1f} us, p99.9 {:.1f} us, max {:.1f} us at tick {}\n", what,
                     us(h.percentile_ns(0.5)), us(h.percentile_ns(0.999)), us(h.max_ns()),
                     h.max_tick());
}

}  // namespace

json to_json(const pc::Environment& e) {
  return {{"kernel_release", e.kernel_release},
          {"kernel_version", e.kernel_version},
          {"realtime_kernel", e.realtime_kernel},
          {"cpu", e.cpu},
          {"cores", e.cores},
          {"clock_source", e.clock_source},
          {"microcode", e.microcode},
          {"boot_parameters", e.boot_parameters},
          {"git_revision", e.git_revision},
          {"compiler", e.compiler},
          {"scene_hash", e.scene_hash}};
}

json to_json(const ThreadCosts& c) {
  // null, not 0, if this build cannot count allocations.
  return {{"allocations", c.heap_calls_known ? json(c.heap_calls) : json(nullptr)},
          {"minor_page_faults", c.minor_faults},
          {"major_page_faults", c.major_faults},
          {"voluntary_context_switches", c.voluntary_switches},
          {"involuntary_context_switches", c.involuntary_switches}};
}

// CLOCK_MONOTONIC; 0: never
json to_json(const loop::StopTimes& t) {
  return {{"missed_ns", t.missed_ns}, {"fault_ns", t.fault_ns}, {"zero_ns", t.zero_ns}};
}

/// The largest forces and energy of the run, next to their limits.
json largest_forces(const RunFacts& facts, const loop::LoopStatistics& loop,
                    const gate::Gate& gate) {
  return {{"force_max_N", loop.max_force_N},
          {"force_limit_N", facts.force_limit_N},
          {"torque_max_Nm", loop.max_torque_Nm},
          {"grip_force_max_N", loop.max_grip_force_N},
          {"force_rms_max_N", loop.max_rms_force_N},
          {"force_continuous_N", gate.continuous_force_N()},
          {"energy_given_max_J", loop.max_given_energy_J},
          {"energy_budget_J", gate.energy_budget_J()}};
}

std::string make_report(const RunFacts& facts, const loop::LoopStatistics& loop,
                        const gate::Gate& gate, const pc::Environment& environment) {
  json shortfalls = json::array(), counts = json::object();
  for (const pc::Shortfall& s : facts.shortfalls) shortfalls.push_back(s.message);
  for (const hal::DeviceCount& one : facts.device_counts) counts[one.name] = one.count;
  json report = {{"format", "tactd-run"},
                 {"version", 1},
                 {"scene", facts.scene_name},
                 {"law", facts.law_title},
                 {"device", facts.device_name},
                 {"device_counts", counts},
                 {"rate_Hz", facts.rate_Hz},
                 {"duration_s", facts.duration_s},
                 {"non_rt", facts.non_rt},
                 {"simulated_time", facts.simulated_time},
                 {"shortfalls", shortfalls},
                 {"ticks", loop.ticks},
                 {"late", loop.late_ticks},
                 {"skipped", loop.skipped_ticks},
                 {"contact_lost", loop.contact_losses},
                 {"inside_ticks", loop.inside_ticks},
                 {"clutches", loop.clutches},
                 {"thread", to_json(facts.costs)},
                 {"phases", phases(loop)},
                 {"limits_checksum", facts.limits_checksum},
                 {"gate", stages(gate)},
                 {"state", name_of(facts.state)},
                 {"fault", fault_entry(facts)},
                 {"stop", to_json(loop.stop)},
                 {"call_filter", facts.call_filter},
                 {"black_boxes", facts.black_boxes},
                 {"dropped_records", facts.dropped_records},
                 {"refused_requests", facts.refused_requests},
                 {"variants", facts.variants},
                 {"dropped_frames", facts.dropped_frames},
                 {"force_hash", fmt::format("{:016x}", facts.force_hash)},
                 {"resident_peak_kB", facts.resident_peak_kB},
                 {"law_table_bytes", facts.law_table_bytes},
                 {"environment", to_json(environment)}};
  report.update(largest_forces(facts, loop, gate));
  return model::io::text_of(report, 2);
}

std::string make_summary(const RunFacts& facts, const loop::LoopStatistics& loop) {
  std::string out =
      fmt::format("{}, law {}, on {}: {} ticks at {:g} Hz, {} late, {} skipped{}\n",
                  facts.scene_name, facts.law_title, facts.device_name, loop.ticks, facts.rate_Hz,
                  loop.late_ticks, loop.skipped_ticks, facts.non_rt ? ", non-rt" : "");
  // The clock does not advance within a simulated tick.
  if (facts.simulated_time) {
    out += "  simulated time: durations are not measured\n";
  } else {
    out += duration_line("wake latency", loop.phase[static_cast<std::size_t>(loop::Phase::kWake)]);
    out += duration_line("tick", loop.phase[static_cast<std::size_t>(loop::Phase::kTotal)]);
  }
  out += fmt::format("  force         max {:.3f} N of {:.2f} N allowed, limits {}, state {}",
                     loop.max_force_N, facts.force_limit_N, facts.limits_checksum,
                     name_of(facts.state));
  if (loop.max_torque_Nm > 0.0)
    out += fmt::format(", torque max {:.1f} mN m", 1e3 * loop.max_torque_Nm);
  if (facts.costs.heap_calls_known)
    out += fmt::format(", {} allocations, {} page faults", facts.costs.heap_calls,
                       facts.costs.minor_faults + facts.costs.major_faults);
  if (loop.contact_losses > 0)
    out += fmt::format("\n  contact lost {} times: the tool moved too far between two samples; {}",
                       loop.contact_losses, model::describe(model::Fault::kContactLost).remedy);
  if (loop.inside_ticks > 0)
    out += fmt::format("\n  the tool was inside the organ, without force, in {} of {} ticks",
                       loop.inside_ticks, loop.ticks);
  if (loop.clutches > 0)
    out += fmt::format("\n  the clutch opened {} times: the tool stayed while the handle moved",
                       loop.clutches);
  // After 5 s a contact is expected; the usual cause is a misplaced organ.
  if (loop.max_force_N == 0.0 && facts.duration_s > 5.0 && facts.fault == model::Fault::kNone)
    out +=
        "\n  nothing was touched: see organ.position_m, organ.mesh_unit_m and hand.site_m in the "
        "scene";
  if (facts.fault != model::Fault::kNone) {
    const model::FaultEntry& fault = model::describe(facts.fault);
    out += fmt::format("\n  fault {}: {}: {}{}{}; {}", static_cast<int>(facts.fault), fault.name,
                       fault.cause, facts.fault_detail.empty() ? "" : ": ", facts.fault_detail,
                       fault.remedy);
  }
  return out;
}

}  // namespace tact::firmware::run
