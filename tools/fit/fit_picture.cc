// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/io/file_writer.h"
#include "tools/fit/fit_report.h"
#include "tools/report/picture.h"

namespace tact::tools::fit {
namespace {

/// One row a sample: what was measured, then what each law says (with its site's factor).
std::string rows_of(const FitReport& report) {
  std::string out = "site,held_out,depth_mm,data_N";
  for (const FittedLaw& law : report.laws) out += "," + law.name + "_N";
  out += "\n";
  std::size_t i = 0;
  for (std::size_t s = 0; s < report.data->sites.size(); ++s) {
    const FitSite& site = report.data->sites[s];
    // Lines are drawn in the order of the rows: by depth, whatever the bench's order.
    std::vector<std::pair<double, std::size_t>> order;
    for (const FitSample& sample : site.samples) order.push_back({sample.depth_m, i++});
    const std::size_t first = i - site.samples.size();
    order.push_back({0.0, i});  // every law passes through rest
    std::sort(order.begin(), order.end());
    for (const auto& [depth_m, at] : order) {
      out += fmt::format("{},{},{:.6g},{:.6g}", site.name, site.held_out ? 1 : 0, 1e3 * depth_m,
                         at < i ? site.samples[at - first].force_N : std::nan(""));
      for (const FittedLaw& law : report.laws)
        out += fmt::format(",{:.6g}",
                           at < i ? law.checked.sites[s].scale * law.answers[at].force_N : 0.0);
      out += "\n";
    }
    out += "\n";  // lines end with their site
  }
  return out;
}

std::string script_of(const FitReport& report, const std::string& csv) {
  constexpr std::size_t kColours = std::size(report::kInk);
  std::string plots = fmt::format(
      "'{0}' using 3:($2==0?$4:NaN) with points pt 7 ps 0.8 lc rgb '#000000' title 'data', "
      "'{0}' using 3:($2==1?$4:NaN) with points pt 6 ps 0.9 lc rgb '#000000' title "
      "'data, held out'",
      csv);
  for (std::size_t k = 0; k < report.laws.size(); ++k)
    plots += fmt::format(", '{}' using 3:{} with lines lw 1.5 lc rgb '{}' title '{} ({:.1f} %)'",
                         csv, k + 5, report::kInk[k % kColours], report.laws[k].title,
                         100.0 * report.laws[k].checked.fitted.rms_ratio());
  return "set xlabel 'depth, mm (pull below 0)'\n"
         "set ylabel 'force, N'\nset key top left\nset grid lc rgb '#dddddd'\n"
         "plot " +
         plots + "\n";
}

}  // namespace

model::Result<std::vector<std::string>> draw_fit(const FitReport& report, const std::string& file) {
  namespace fs = std::filesystem;
  if (!report.data || report.laws.empty())
    return model::Error{
        "no law was fitted, so there is nothing to draw; give --data or --reference"};
  const fs::path path(file);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::string csv = path.stem().string() + ".points.csv";
  if (auto error = model::io::write_file((fs::path(folder) / csv).string(), rows_of(report)))
    return *error;
  return report::draw({.name = path.stem().string(), .script = script_of(report, csv)}, folder);
}

}  // namespace tact::tools::fit
