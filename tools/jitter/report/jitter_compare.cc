// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/report/jitter_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::tools::jitter {
namespace {

using model::Error;
using model::Result;
using nlohmann::json;

constexpr std::array kShown{"p50", "p99", "p99.9", "p99.99", "max"};
// Not p99.99 and not the largest: a handful of samples makes them.
constexpr std::array kCheckedShares{"p50", "p99", "p99.9"};
constexpr std::array kCheckedSeries{"wake", "every_wake", "total", "deadline_to_force"};
// The clock's own steps and the cache lie below (jitter_compare.h).
constexpr std::uint64_t kMin_ns = 1000;

template <typename List>
bool is_one_of(const List& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Version 1 had both in one word; what is compared is the same in both.
bool is_known_format(const json& result) {
  const json format = result.value("format", json());
  return format == "tact-jitter 1" ||
         (format == "tact-jitter" && result.value("version", json()) == 2);
}

bool is_result(const json& result) {
  return result.is_object() && is_known_format(result) &&
         result.value("series", json()).is_object();
}

std::optional<std::uint64_t> value_of(const json& series, const char* share) {
  const auto value = series.is_object() ? series.value(std::string(share) + "_ns", json()) : json();
  if (!value.is_number_unsigned()) return std::nullopt;
  return value.get<std::uint64_t>();
}

void note_unlike(const json& a, const json& b, const char* key, std::vector<std::string>& unlike) {
  const json left = a.value(key, json()), right = b.value(key, json());
  if (left != right)
    unlike.push_back(
        fmt::format("{} {} and {}", key, model::io::text_of(left), model::io::text_of(right)));
}

}  // namespace

double ComparedValue::change_ratio() const {
  // No ratio to nothing.
  if (before_ns == 0) return 0.0;
  return static_cast<double>(after_ns) / static_cast<double>(before_ns) - 1.0;
}

bool Comparison::is_worse() const {
  return std::any_of(values.begin(), values.end(), [](const ComparedValue& v) { return v.worse; });
}

bool Comparison::checked_any() const {
  return std::any_of(values.begin(), values.end(),
                     [](const ComparedValue& v) { return v.checked; });
}

Result<Comparison> compare_results(const json& before, const json& after,
                                   std::optional<double> gate_ratio) {
  if (!is_result(before) || !is_result(after))
    return Error{"not a result of tact-jitter; give two jitter.json of its --out folders"};
  Comparison out;
  // Reported, not refused: one may want to see what another kernel gives.
  for (const char* key : {"subject", "rate_Hz", "load", "armed", "core", "priority", "non_rt"})
    note_unlike(before, after, key, out.unlike);
  for (const char* key : {"kernel_release", "boot_parameters", "cpu", "microcode", "clock_source",
                          "compiler", "scene_hash"})
    note_unlike(before.value("environment", json::object()),
                after.value("environment", json::object()), key, out.unlike);
  for (const auto& [name, series] : before["series"].items()) {
    const json other = after["series"].value(name, json());
    for (const char* share : kShown) {
      const auto a = value_of(series, share), b = value_of(other, share);
      // Without a sample beyond it a percentile is none (jitter_report.h).
      if (!a || !b) continue;  // too few samples in one of them
      ComparedValue value{.series = name, .share = share, .before_ns = *a, .after_ns = *b};
      value.checked =
          gate_ratio && is_one_of(kCheckedSeries, name) && is_one_of(kCheckedShares, share);
      value.worse = value.checked && *b > *a + kMin_ns && value.change_ratio() > *gate_ratio;
      out.values.push_back(value);
    }
  }
  return out;
}

Result<json> load_result(const std::string& path) {
  constexpr const char* kRemedy = "name a jitter.json of tact-jitter --out";
  auto result = model::io::read_json(path, kRemedy);
  if (result && !is_result(*result))
    return Error{fmt::format("{}: is no result of tact-jitter; {}", path, kRemedy)};
  return result;
}

std::string make_comparison_text(const Comparison& comparison) {
  std::string out;
  for (const std::string& what : comparison.unlike) out += fmt::format("not alike: {}\n", what);
  out +=
      fmt::format("{:20} {:8} {:>12} {:>12} {:>9}\n", "", "", "before, us", "after, us", "change");
  for (const ComparedValue& v : comparison.values)
    out +=
        fmt::format("{:20} {:8} {:>12.3f} {:>12.3f} {:>+8.1f} %{}\n", v.series, v.share,
                    1e-3 * static_cast<double>(v.before_ns), 1e-3 * static_cast<double>(v.after_ns),
                    1e2 * v.change_ratio(), v.worse ? "  WORSE" : "");
  return out;
}

json to_json(const Comparison& comparison) {
  json values = json::array();
  for (const ComparedValue& v : comparison.values)
    values.push_back({{"series", v.series},
                      {"share", v.share},
                      {"before_ns", v.before_ns},
                      {"after_ns", v.after_ns},
                      {"change_ratio", v.change_ratio()},
                      {"judged", v.checked},
                      {"worse", v.worse}});
  return {{"format", "tact-jitter-compare"},
          {"version", 1},
          {"values", values},
          {"unlike", comparison.unlike},
          {"worse", comparison.is_worse()}};
}

}  // namespace tact::tools::jitter
