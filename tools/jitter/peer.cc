#include "tools/jitter/peer.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tact::tools {
namespace {

using model::Error;

constexpr int kBuckets_us = 50000;  // longer stalls than this are counted as the largest
constexpr std::int64_t kMicrosecond_ns = 1000;

std::int64_t upper_edge_ns(std::int64_t us) { return (us + 1) * kMicrosecond_ns - 1; }

}  // namespace

std::vector<std::string> cyclictest_arguments(const PeerCall& call, const std::string& json_path) {
  return {"-q",
          "-m",
          "-t1",
          "-p" + std::to_string(call.priority),
          "-a" + std::to_string(call.core),
          "-i" + std::to_string(call.period_ns / kMicrosecond_ns),
          "-l" + std::to_string(
                     std::llround(call.duration_s * 1e9 / static_cast<double>(call.period_ns))),
          "-h" + std::to_string(kBuckets_us),
          "--json=" + json_path};
}

std::optional<Error> add_cyclictest(const std::string& text, Series& series) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto thread = json.is_object() && json.contains("thread") && json["thread"].is_object()
                          ? json["thread"].value("0", nlohmann::json())
                          : nlohmann::json();
  if (!thread.is_object() || !thread.contains("histogram") || !thread["histogram"].is_object() ||
      !thread.value("cycles", nlohmann::json()).is_number_unsigned() ||
      !thread.value("max", nlohmann::json()).is_number_unsigned())
    return Error{"cyclictest told no histogram of a thread; this reads rt-tests 2.4"};
  std::uint64_t told = 0;
  const auto add = [&](std::int64_t us, std::uint64_t samples) {
    for (std::uint64_t i = 0; i < samples; ++i)
      series.record(upper_edge_ns(us), series.histogram.count(), 0);
    told += samples;
  };
  for (const auto& [us, samples] : thread["histogram"].items())
    if (samples.is_number_unsigned())
      add(std::strtoll(us.c_str(), nullptr, 10), samples.get<std::uint64_t>());
  const auto cycles = thread["cycles"].get<std::uint64_t>();
  if (told < cycles) add(thread["max"].get<std::int64_t>(), cycles - told);
  return std::nullopt;
}

std::optional<Error> run_cyclictest(const PeerCall& call, const ScratchFolder& folder,
                                    Series& series) {
  const std::string json_path = folder.file("cyclictest.json");
  const auto said = run_program({.program = "cyclictest",
                                 .arguments = cyclictest_arguments(call, json_path),
                                 .directory = folder.path(),
                                 .log_path = folder.file("cyclictest.txt"),
                                 .package = "rt-tests",
                                 .time_limit_s = 60.0 + 5.0 * call.duration_s,
                                 .environment = {}});
  if (!said) return said.error();
  std::ostringstream text;
  text << std::ifstream(json_path).rdbuf();
  return add_cyclictest(text.str(), series);
}

}  // namespace tact::tools
