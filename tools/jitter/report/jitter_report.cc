// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/report/jitter_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "firmware/run/report.h"

namespace tact::tools::jitter {
namespace {

using firmware::loop::LatencyHistogram;
using firmware::loop::Phase;
using nlohmann::json;

json series_json(const JitterResult& result, const NamedSeries& named) {
  const LatencyHistogram& h = named.series->histogram;
  json out{{"title", named.title},
           {"samples", h.count()},
           {"max_ns", h.max_ns()},
           {"max_tick", h.max_tick()},
           {"max_at_s", seconds_into(result, named.series->max_at_ns)}};
  for (const Share& share : kShares) {
    const auto ns = percentile_ns(h, share.value);
    out[std::string(share.name) + "_ns"] = ns ? json(*ns) : json(nullptr);
  }
  json buckets = json::array();
  // All of them: others can make their own shares out of it.
  h.for_each_bucket([&](std::uint64_t low_ns, std::uint64_t high_ns, std::uint64_t samples) {
    buckets.push_back({low_ns, high_ns, samples});
  });
  out["buckets_ns"] = buckets;
  return out;
}

json late_json(const JitterResult& result, const LateTick& late) {
  json phases;
  for (std::size_t i = 0; i < firmware::loop::kPhaseCount; ++i)
    phases[firmware::loop::kPhaseName[i]] = late.times.phase_ns[i];
  return {{"tick", late.times.tick},
          {"at_s", seconds_into(result, late.times.due_ns)},
          {"due_ns", late.times.due_ns},
          // The total, which reaches the hand; the phases show its parts.
          {"deadline_to_force_ns", late.worst_ns},
          {"skipped_before", late.times.skipped_before},
          {"phases_ns", phases},
          {"kernel_counted", late.attribution}};
}

json to_json(const std::optional<TurnRatios>& middle) {
  if (!middle) return nullptr;
  return {{"turns", middle->turns},
          {"lower_quartile", middle->lower_quartile},
          {"median", middle->median},
          {"upper_quartile", middle->upper_quartile}};
}

json to_json(const std::optional<PeerVerdict>& verdict) {
  if (!verdict) return nullptr;
  return {{"most", verdict->most_ratio},
          {"passed", verdict->turns ? json(verdict->passed()) : json(nullptr)},
          {"sentence", verdict->message()}};
}

}  // namespace

std::vector<NamedSeries> series_of(const JitterResult& result) {
  const TickSink& sink = *result.sink;
  std::vector<NamedSeries> all;
  const auto add = [&](const char* key, const char* title, const Series& series) {
    // A phase that the run does not have (a bare loop has none but wake-up) is all zeros.
    if (series.histogram.max_ns() > 0) all.push_back({key, title, &series});
  };
  add("wake", "wake-up", sink.phase(Phase::kWake));
  if (result.peer) add("peer_wake", "wake-up of cyclictest", *result.peer);
  add("every_wake", "every wake-up", sink.every_wake());
  for (const Phase p : {Phase::kRead, Phase::kDetect, Phase::kRender, Phase::kLimit, Phase::kWrite,
                        Phase::kPublish}) {
    const char* name = firmware::loop::kPhaseName[static_cast<std::size_t>(p)];
    add(name, name, sink.phase(p));
  }
  add("total", "tick", sink.phase(Phase::kTotal));
  // A bare loop hands no force to anybody.
  if (!result.scene_hash.empty())
    add("deadline_to_force", "deadline to force", sink.deadline_to_force());
  add("round_trip", "device round trip", sink.round_trip());
  if (result.pin) add("pin", "input to force, at the pin", result.pin->pulses());
  return all;
}

std::optional<double> ratio_to_peer(const JitterResult& result) {
  if (!result.peer) return std::nullopt;
  return ratio_at_p999(result.sink->phase(Phase::kWake), *result.peer);
}

std::string compare_with_peer(const JitterResult& result) {
  const auto ratio = ratio_to_peer(result);
  if (!ratio) return "Too few samples for a ratio at p99.9";
  const auto middle = middle_of(result.turn_ratios);
  return fmt::format(
      "wake-up p99.9 is {:.2f} of cyclictest's in the same run{}", *ratio,
      middle ? fmt::format(
                   "; turn by turn {:.2f} in the median of {}, half of them {:.2f} to {:.2f}",
                   middle->median, middle->turns, middle->lower_quartile, middle->upper_quartile)
             : "");
}

std::optional<PeerVerdict> check_peer(const JitterResult& result) {
  if (!result.peer_gate) return std::nullopt;
  return PeerVerdict{*result.peer_gate, middle_of(result.turn_ratios)};
}

Outcome answer_of(const JitterResult& result) {
  const TickSink& sink = *result.sink;
  if (sink.ticks() == 0) return {"part", "NOT JUDGED: no tick was measured"};
  // tactd refuses a law that takes more than half a period: the other half is for the wake-up.
  const double half_us = 0.5e6 / result.rate_Hz;
  const double latest_us = 1e-3 * static_cast<double>(sink.every_wake().histogram.max_ns());
  const auto red =
      std::ranges::count(result.pc, firmware::pc::Verdict::kRed, &firmware::pc::PcRow::verdict);
  std::string why;
  if (sink.skipped() > 0) why += fmt::format("{} deadlines were missed; ", sink.skipped());
  if (latest_us > half_us)
    why += fmt::format("the latest wake-up was {:.0f} us, above {:g} us, half a period; ",
                       latest_us, half_us);
  if (result.non_rt) why += "it gives no hard real time, so tactd caps the force to a quarter; ";
  const auto seen = fmt::format("{:.3g} s {}", result.measured_s,
                                result.load.empty() ? "without load" : "under load " + result.load);
  if (!why.empty())
    return {"fail", fmt::format("this PC is not good enough for {:g} Hz, because in {} "
                                "{}{} red rows of tact-doctor say what to change",
                                result.rate_Hz, seen, why, red)};
  return {"pass",
          fmt::format(
              "this PC is good enough for {:g} Hz, because in {} no deadline was missed and the "
              "latest wake-up was {:.3g} us of {:g} us, half a period{}",
              result.rate_Hz, seen, latest_us, half_us,
              result.measured_s < 600.0 || result.load.empty()
                  ? "; before a person holds a device: --duration 3600 --load cpu,memory,disk,net"
                  : "")};
}

Outcome outcome_of(const JitterResult& result) {
  const auto verdict = check_peer(result);
  if (!result.fault.empty()) return {"fail", "FAIL: the run ended with a fault: " + result.fault};
  if (result.interrupted) return {"part", "NOT JUDGED: the run was ended by Ctrl-C"};
  if (!verdict) return answer_of(result);
  // Too few turns is neither pass nor fail: a script must not take it for one of them.
  if (!verdict->turns) return {"part", "NOT JUDGED: " + verdict->message()};
  return {verdict->passed() ? "pass" : "fail", verdict->message()};
}

int exit_status(const JitterResult& result) {
  const auto verdict = check_peer(result);
  if (!result.fault.empty()) return 1;
  // Without a gate nothing was promised.
  if (!verdict || verdict->passed()) return 0;
  // Too few turns: nothing could be judged.
  return verdict->turns ? 1 : 2;
}

double seconds_into(const JitterResult& result, std::int64_t at_ns) {
  return at_ns == 0 ? 0.0 : 1e-9 * static_cast<double>(at_ns - result.sink->first_due_ns());
}

std::string in_us(std::optional<std::uint64_t> duration_ns) {
  if (!duration_ns) return "-";
  const double us = 1e-3 * static_cast<double>(*duration_ns);
  // Three digits: more would be the clock's noise.
  return us >= 100.0 ? fmt::format("{:.0f}", us) : fmt::format("{:.3g}", us);
}

std::string make_headline(const JitterResult& result) {
  const TickSink& sink = *result.sink;
  return fmt::format(
      "{}: {} ticks at {:g} Hz in {:.6g} s on core {}, FIFO {}, {}{}; {} late, {} skipped{}{}{}",
      result.subject, sink.ticks(), result.rate_Hz, result.measured_s, result.core, result.priority,
      result.load.empty() ? "idle" : "load " + result.load,
      result.scene_hash.empty() || result.armed ? "" : ", not armed (force is zero)", sink.late(),
      sink.skipped(),
      sink.unseen() > 0 ? fmt::format(", {} not seen by this program", sink.unseen()) : "",
      result.interrupted ? ", ended by Ctrl-C" : "", result.non_rt ? ", non-rt" : "");
}

std::string make_summary(const JitterResult& result) {
  std::string out = make_headline(result) + fmt::format("\n{:28} {:>9}", "us", "samples");
  for (const Share& share : kShares) out += fmt::format(" {:>8}", share.name);
  out += fmt::format(" {:>8}\n", "largest");
  for (const NamedSeries& named : series_of(result)) {
    const LatencyHistogram& h = named.series->histogram;
    out += fmt::format("  {:26} {:>9}", named.title, h.count());
    for (const Share& share : kShares)
      out += fmt::format(" {:>8}", in_us(percentile_ns(h, share.value)));
    out += fmt::format(" {:>8}", in_us(h.max_ns()));
    out += named.key == "peer_wake" ? "\n"
                                    : fmt::format("  tick {}, {:.3f} s\n", h.max_tick(),
                                                  seconds_into(result, named.series->max_at_ns));
  }
  out += fmt::format("the largest is that of {} ticks: it bounds nothing\n", result.sink->ticks());
  if (result.peer) out += compare_with_peer(result) + "\n";
  if (const auto verdict = check_peer(result)) out += verdict->message() + "\n";
  const auto& thread = result.thread;
  out += fmt::format("loop's thread: {} heap calls, {} page faults, {} involuntary switches\n",
                     thread.heap_calls_known ? std::to_string(thread.heap_calls) : "unknown",
                     thread.minor_faults + thread.major_faults, thread.involuntary_switches);
  out += fmt::format("around it: {}\n", describe(result.costs));
  out += fmt::format("{} ticks over {} us from deadline to force", result.sink->over_threshold(),
                     in_us(static_cast<std::uint64_t>(result.sink->threshold_ns())));
  const auto late = result.sink->late_ticks();
  for (std::size_t i = 0; i < std::min<std::size_t>(late.size(), 3); ++i)
    out += fmt::format("\n  {} us at tick {}, {:.3f} s: {}",
                       in_us(static_cast<std::uint64_t>(late[i].worst_ns)), late[i].times.tick,
                       seconds_into(result, late[i].times.due_ns), late[i].attribution);
  if (!result.fault.empty()) return out + "\nfault " + result.fault;
  return out + "\n" + answer_of(result).message;
}

json to_json(const JitterResult& result, const std::string& command) {
  json series, order = json::array(), late = json::array(), shortfalls = json::array();
  for (const NamedSeries& named : series_of(result)) {
    series[named.key] = series_json(result, named);
    order.push_back(named.key);
  }
  for (const LateTick& tick : result.sink->late_ticks()) late.push_back(late_json(result, tick));
  for (const firmware::pc::Shortfall& s : result.shortfalls) shortfalls.push_back(s.message);
  const auto ratio = ratio_to_peer(result);
  return {{"format", "tact-jitter"},
          {"version", 2},
          {"began", result.began_utc},
          {"host", result.host},
          {"outcome", outcome_of(result).message},
          {"outcome_verdict", outcome_of(result).verdict},
          {"headline", make_headline(result)},
          {"command", command},
          {"subject", result.subject},
          {"rate_Hz", result.rate_Hz},
          {"measured_s", result.measured_s},
          {"core", result.core},
          {"priority", result.priority},
          {"load", result.load},
          {"armed", result.armed},
          {"interrupted", result.interrupted},
          {"non_rt", result.non_rt},
          {"shortfalls", shortfalls},
          {"ticks", result.sink->ticks()},
          {"late", result.sink->late()},
          {"skipped", result.sink->skipped()},
          {"unseen", result.sink->unseen()},
          {"threshold_ns", result.sink->threshold_ns()},
          {"over_threshold", result.sink->over_threshold()},
          {"series", series},
          {"series_order", order},
          {"pin_edges_unpaired", result.pin ? json(result.pin->unpaired()) : json(nullptr)},
          {"wake_p99.9_over_peer", ratio ? json(*ratio) : json(nullptr)},
          {"wake_p99.9_over_peer_by_turn", to_json(middle_of(result.turn_ratios))},
          {"compared_with_peer", result.peer ? json(compare_with_peer(result)) : json(nullptr)},
          {"peer_gate", to_json(check_peer(result))},
          {"thread", firmware::run::to_json(result.thread)},
          {"kernel", to_json(result.costs)},
          {"late_ticks", late},
          {"marked_in_ftrace", result.has_marker},
          {"fault", result.fault},
          {"pc", firmware::pc::to_json(result.pc)},
          {"environment", firmware::run::to_json(result.environment)}};
}

}  // namespace tact::tools::jitter
