// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::tools::jitter {
namespace {

using model::Error;

constexpr int kBuckets_us = 50000;  // longer stalls than this are counted as the largest
constexpr std::int64_t kMicrosecond_ns = 1000;

/// A bucket of us holds all up to the next microsecond; ours count at their upper edge, too.
std::int64_t upper_edge_ns(std::int64_t us) { return (us + 1) * kMicrosecond_ns - 1; }

}  // namespace

std::uint64_t cycles_of(const PeerCall& call) {
  return static_cast<std::uint64_t>(
      std::llround(call.duration_s * 1e9 / static_cast<double>(call.period_ns)));
}

std::vector<std::string> cyclictest_arguments(const PeerCall& call, const std::string& json_path) {
  return {"-q",
          "-m",
          "-t1",
          "-p" + std::to_string(call.priority),
          "-a" + std::to_string(call.core),
          "-i" + std::to_string(call.period_ns / kMicrosecond_ns),
          "-l" + std::to_string(cycles_of(call)),
          "-h" + std::to_string(kBuckets_us),
          "--json=" + json_path};
}

std::optional<Error> add_cyclictest(const std::string& text, std::uint64_t asked_cycles,
                                    Series& series) {
  // Another program's file: each member is asked for before it is used.
  const auto parsed = model::io::parse_json(text, "cyclictest");
  const nlohmann::json json = parsed ? *parsed : nlohmann::json();
  const auto thread = json.is_object() && json.contains("thread") && json["thread"].is_object()
                          ? json["thread"].value("0", nlohmann::json())
                          : nlohmann::json();
  if (!thread.is_object() || !thread.contains("histogram") || !thread["histogram"].is_object() ||
      !thread.value("cycles", nlohmann::json()).is_number_unsigned() ||
      !thread.value("max", nlohmann::json()).is_number_unsigned())
    return Error{"cyclictest printed no histogram of a thread; this reads rt-tests 2.4"};
  const auto cycles = thread["cycles"].get<std::uint64_t>();
  // Counted before one is recorded: a file that claims 2^60 samples would keep the loop below busy.
  std::uint64_t counted = 0;
  for (const auto& [us, samples] : thread["histogram"].items()) {
    if (!samples.is_number_unsigned()) continue;
    const auto more = samples.get<std::uint64_t>();
    counted =
        more > asked_cycles - std::min(counted, asked_cycles) ? asked_cycles + 1 : counted + more;
  }
  if (cycles > asked_cycles || counted > asked_cycles)
    return Error{
        fmt::format("cyclictest reported more samples than the {} cycles it was asked for; "
                    "this reads rt-tests 2.4",
                    asked_cycles)};
  std::uint64_t reported = 0;
  const auto add = [&](std::int64_t us, std::uint64_t samples) {
    for (std::uint64_t i = 0; i < samples; ++i)
      series.record(upper_edge_ns(us), series.histogram.count(), 0);
    reported += samples;
  };
  for (const auto& [us, samples] : thread["histogram"].items())
    if (samples.is_number_unsigned())
      add(std::strtoll(us.c_str(), nullptr, 10), samples.get<std::uint64_t>());
  // What lies beyond its histogram has no bucket: all of it counts as the largest.
  if (reported < cycles) add(thread["max"].get<std::int64_t>(), cycles - reported);
  return std::nullopt;
}

std::optional<double> ratio_at_p999(const Series& loop, const Series& peer) {
  const auto own = percentile_ns(loop.histogram, 0.999);
  const auto theirs = percentile_ns(peer.histogram, 0.999);
  if (!own || !theirs || *theirs == 0) return std::nullopt;
  return static_cast<double>(*own) / static_cast<double>(*theirs);
}

std::optional<TurnRatios> middle_of(std::vector<double> ratios) {
  // A median of two is decided by either of them.
  if (ratios.size() < 3) return std::nullopt;
  std::ranges::sort(ratios);
  const auto at = [&](double share) {
    return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1) + 0.5)];
  };
  return TurnRatios{ratios.size(), at(0.25), at(0.5), at(0.75)};
}

std::string PeerVerdict::message() const {
  if (!turns)
    return fmt::format(
        "--peer-gate {:g} could not be judged: fewer than three turns with a p99.9; measure for "
        "longer (hardware and safety lines take no turns)",
        most_ratio);
  return fmt::format(
      "{}: wake-up p99.9 is {:.2f} of cyclictest's in the median of {} turns, allowed are {:g}",
      passed() ? "PASS" : "FAIL", turns->median, turns->turns, most_ratio);
}

std::optional<Error> run_cyclictest(const PeerCall& call, const program::ScratchFolder& folder,
                                    Series& series) {
  const std::string json_path = folder.file("cyclictest.json");
  const auto said = program::run_program({.program = "cyclictest",
                                          .arguments = cyclictest_arguments(call, json_path),
                                          .directory = folder.path(),
                                          .log_path = folder.file("cyclictest.txt"),
                                          .package = "rt-tests",
                                          // Generous: under load cyclictest may be late, too;
                                          // without it a hang would be for ever.
                                          .time_limit_s = 60.0 + 5.0 * call.duration_s});
  if (!said) return said.error();
  const auto text = model::io::read_file(json_path);
  if (!text) return text.error();
  return add_cyclictest(*text, cycles_of(call), series);
}

}  // namespace tact::tools::jitter
