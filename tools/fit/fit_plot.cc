// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "model/io/file_writer.h"
#include "tools/fit/fit_report.h"

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
    // Lines are drawn in the order of the rows: by depth, independent of the bench's order.
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

/// "rhombus (1.2 %)"
std::vector<std::string> titles_of(const FitReport& report) {
  std::vector<std::string> titles;
  for (const FittedLaw& law : report.laws)
    titles.push_back(
        fmt::format("{} ({:.1f} %)", law.title, 100.0 * law.checked.fitted.rms_ratio()));
  return titles;
}

}  // namespace

model::Result<nlohmann::json> picture_of(const FitReport& report, const std::string& file) {
  namespace fs = std::filesystem;
  if (!report.data || report.laws.empty())
    return model::Error{
        "no law was fitted, so there is nothing to draw; give --data or --reference"};
  const fs::path path(file);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::string name = path.stem().string();
  if (auto error = model::io::write_file((fs::path(folder) / (name + ".points.csv")).string(),
                                         rows_of(report)))
    return *error;
  return nlohmann::json{
      {"label", "tact-lab fit"},
      {"folder", folder},
      {"name", name},
      {"script", "fit.gp"},
      {"variables", {{"width_px", 1200}, {"height_px", 800}, {"laws", titles_of(report)}}}};
}

}  // namespace tact::tools::fit
