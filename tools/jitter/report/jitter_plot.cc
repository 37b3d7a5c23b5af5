// SPDX-License-Identifier: Apache-2.0
// The histograms of a run as a picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/io/file_writer.h"
#include "tools/jitter/report/jitter_report.h"
#include "tools/jitter/report/scripts.h"
#include "tools/report/plot.h"

namespace tact::tools::jitter {
namespace {

// Below it lies the clock's own reading; twenty buckets a decade show a width of 12 %.
constexpr double kFirst_us = 0.1;
constexpr int kPerDecade = 20;

std::size_t bin_of(std::uint64_t ns) {
  const double decades =
      std::log10(std::max(1e-3 * static_cast<double>(ns), kFirst_us) / kFirst_us);
  // A value on an edge belongs to the bucket above it, for any rounding of the logarithm.
  return static_cast<std::size_t>(decades * kPerDecade + 1e-9);
}

std::vector<NamedSeries> drawn_series(const JitterResult& result) {
  std::vector<NamedSeries> drawn;
  for (const NamedSeries& named : series_of(result))
    for (const char* key : {"wake", "peer_wake", "total", "deadline_to_force"})
      if (named.key == key) drawn.push_back(named);
  return drawn;
}

}  // namespace

std::string make_histogram_csv(const JitterResult& result) {
  const auto drawn = drawn_series(result);
  std::vector<std::vector<std::uint64_t>> samples(drawn.size());
  std::size_t bins = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    drawn[i].series->histogram.for_each_bucket(
        [&](std::uint64_t low_ns, std::uint64_t high_ns, std::uint64_t count) {
          const std::size_t bin = bin_of((low_ns + high_ns) / 2);
          if (bin >= samples[i].size()) samples[i].resize(bin + 1);
          samples[i][bin] += count;
          bins = std::max(bins, bin + 1);
        });
  std::string out = "from_us";
  for (const NamedSeries& named : drawn) out += "," + named.key;
  for (std::size_t bin = 0; bin <= bins; ++bin) {  // the last one is empty: steps end there
    out +=
        fmt::format("\n{:.6g}", kFirst_us * std::pow(10.0, static_cast<double>(bin) / kPerDecade));
    for (const auto& column : samples)
      out += fmt::format(",{}", bin < column.size() ? column[bin] : 0);
  }
  return out + "\n";
}

model::Result<std::vector<std::string>> draw_histogram(const JitterResult& result,
                                                       const std::string& directory) {
  const auto drawn = drawn_series(result);
  if (auto error = model::io::write_file(directory + "/histogram.csv", make_histogram_csv(result)))
    return *error;
  std::vector<std::string> titles;
  double peer = 0.0;
  for (const NamedSeries& named : drawn) {
    titles.push_back(named.title);
    if (named.key == "peer_wake") peer = static_cast<double>(titles.size());
  }
  return report::draw(
      {.name = "histogram",
       .width_px = 1000,
       .height_px = 520,
       .script = kHistogramScript,
       .variables = {{"run",
                      fmt::format("{} ticks at {:g} Hz, {}", result.sink->ticks(), result.rate_Hz,
                                  result.load.empty() ? "idle" : "load " + result.load)},
                     {"series", titles},
                     {"peer", peer}}},
      directory);
}

}  // namespace tact::tools::jitter
