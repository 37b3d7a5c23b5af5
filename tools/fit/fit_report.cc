// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tact::tools::fit {
namespace {

using nlohmann::ordered_json;

double checked_ratio(const FittedLaw& law) {
  const Evaluation& j = law.checked;
  // More parameters never fit worse: only a site that the law has not seen can show it.
  return j.held_out.samples > 0 ? j.held_out.rms_ratio() : j.fitted.rms_ratio();
}

std::string percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.2f} %", 100.0 * ratio) : "-";
}

std::string line_of(const char* what, const Residual& r) {
  if (r.samples == 0) return {};
  return fmt::format(
      "  {:10} RMS {:8.3g} N {:>8}   worst {:8.3g} N {:>8}   of the own force {:>8}   {} samples\n",
      what, r.rms_N, percent(r.rms_ratio()), r.worst_N, percent(r.worst_ratio()),
      percent(r.local_ratio), r.samples);
}

/// Sections of some keys; `written` are the keys that others wrote before.
std::string toml_of_keys(const FittedLaw& law, std::vector<std::string>& written) {
  std::string out, section;
  const auto known = [&](const std::string& name) {
    return std::find(written.begin(), written.end(), name) != written.end();
  };
  std::vector<std::string> mine;
  bool wrote_choice = law.choice.empty();
  for (const FittedKey& k : law.keys) {
    const std::string name = k.section + "." + k.key;
    // TOML refuses a key or a section that occurs twice, so later laws have theirs as comments.
    const char* mark = known(name) ? "# " : "";
    if (k.section != section) {
      section = k.section;
      const bool has_section = known(section);
      out += fmt::format("{}[{}]\n", has_section ? "# " : "", section);
      // Such as the form of a disc: without it the numbers below are those of another law.
      if (!wrote_choice) out += fmt::format("{}{}\n", has_section ? "# " : "", law.choice);
      wrote_choice = true;
      mine.push_back(section);
      if (has_section) mark = "# ";
    } else if (known(section)) {
      mark = "# ";
    }
    out += fmt::format("{}{} = {:.5g}{}\n", mark, k.key, k.value,
                       k.at_bound ? "  # at the end of its range" : "");
    mine.push_back(name);
  }
  written.insert(written.end(), mine.begin(), mine.end());
  return out;
}

std::string toml_of_relaxation(const PronyFit& fit) {
  std::string out;
  for (const model::law::PronyTerm& term : fit.terms)
    out += fmt::format("[[relaxation]]\nshare_ratio = {:.4g}\ntime_s = {:.4g}\n", term.share,
                       term.time_s);
  return out;
}

std::string text_of_law(const FittedLaw& law) {
  const Evaluation& j = law.checked;
  std::string out = fmt::format("\n{}: {}, {}\n", law.name, law.title,
                                j.follows ? "follows the data" : "CANNOT FOLLOW the data");
  for (const std::string& reason : j.reasons) out += "  " + reason + "\n";
  out += line_of("fitted", j.fitted) + line_of("held out", j.held_out);
  out += line_of("press", j.press) + line_of("pull", j.pull);
  if (std::isfinite(j.shape_rms_ratio) || std::isfinite(j.held_out_shape_rms_ratio))
    out += fmt::format("  shape      {} of the depth, held out {}\n", percent(j.shape_rms_ratio),
                       percent(j.held_out_shape_rms_ratio));
  if (j.sites.size() > 1) {
    const bool by_site = std::any_of(j.sites.begin(), j.sites.end(),
                                     [](const SiteResidual& s) { return s.scale != 1.0; });
    out += "  site       peak N   RMS of it    worst     shape    factor\n";
    for (const SiteResidual& s : j.sites)
      out += fmt::format("  {:9} {:7.3g} {:>11} {:>8} {:>9} {:9.3f}{}\n", s.name, s.force.peak_N,
                         percent(s.force.rms_ratio()), percent(s.force.worst_ratio()),
                         percent(s.shape_rms_ratio), s.best_scale, s.held_out ? "  held out" : "");
    out += fmt::format("  factor: {}\n", by_site ? "of each site's force, used above"
                                                 : "what would suit the site best; not used");
  }
  // On the screen each law is alone.
  std::vector<std::string> none;
  return out + toml_of_keys(law, none);
}

ordered_json json_of(const Residual& r) {
  return {{"samples", r.samples},        {"rms_N", r.rms_N},
          {"worst_N", r.worst_N},        {"peak_N", r.peak_N},
          {"rms_ratio", r.rms_ratio()},  {"worst_ratio", r.worst_ratio()},
          {"local_ratio", r.local_ratio}};
}

ordered_json json_of(const FittedLaw& law) {
  const Evaluation& j = law.checked;
  ordered_json sites = ordered_json::array(), keys = ordered_json::array();
  for (const SiteResidual& s : j.sites)
    sites.push_back({{"site", s.name},
                     {"held_out", s.held_out},
                     {"force", json_of(s.force)},
                     {"scale", s.scale},
                     {"best_scale", s.best_scale},
                     {"shape_rms_ratio", s.shape_rms_ratio}});
  for (const FittedKey& k : law.keys)
    keys.push_back(
        {{"section", k.section}, {"key", k.key}, {"value", k.value}, {"at_bound", k.at_bound}});
  return {{"law", law.name},
          {"title", law.title},
          {"follows", j.follows},
          {"reasons", j.reasons},
          {"keys", keys},
          {"fitted", json_of(j.fitted)},
          {"held_out", json_of(j.held_out)},
          {"press", json_of(j.press)},
          {"pull", json_of(j.pull)},
          {"shape_rms_ratio", j.shape_rms_ratio},
          {"held_out_shape_rms_ratio", j.held_out_shape_rms_ratio},
          {"sites", sites},
          {"evaluations", law.evaluations}};
}

}  // namespace

bool FitReport::follows() const {
  const bool one = laws.empty() || std::any_of(laws.begin(), laws.end(), [](const FittedLaw& law) {
                     return law.checked.follows;
                   });
  return one && (!relaxation || relaxation->is_good);
}

void FitReport::sort() {
  std::sort(laws.begin(), laws.end(), [](const FittedLaw& a, const FittedLaw& b) {
    // By name where two are alike: std::sort keeps no order of its own.
    return std::tuple(checked_ratio(a), a.name) < std::tuple(checked_ratio(b), b.name);
  });
}

std::string text_of(const FitReport& report) {
  std::string out;
  if (report.data)
    out += fmt::format(
        "data       {}: {} site{}, peak {:.3g} N, press to {:.3g} mm, pull to {:.3g} "
        "mm\n",
        report.data->source, report.data->sites.size(), report.data->sites.size() == 1 ? "" : "s",
        report.data->peak_N(), 1e3 * report.data->deepest_m(),
        1e3 * report.data->farthest_pull_m());
  for (const FittedLaw& law : report.laws) out += text_of_law(law);
  if (const auto& r = report.relaxation) {
    out += fmt::format("\nrelaxation: {:.3g} N at once, {} terms, RMS {} of it, worst {}{}\n",
                       r->initial_N, r->terms.size(), percent(r->residual_ratio),
                       percent(r->worst_ratio), r->is_good ? "" : ": CANNOT FOLLOW the data");
    out += toml_of_relaxation(*r);
  }
  for (const std::string& note : report.notes) out += "\nnote: " + note + "\n";
  return out;
}

std::string toml_of(const FitReport& report) {
  std::string out = "# By tact-lab fit";
  if (report.data) out += ", from " + report.data->source;
  out += "\n";
  std::vector<std::string> written;
  for (const FittedLaw& law : report.laws) {
    out += fmt::format(
        "\n# {}: RMS {} of the peak, held-out sites {}\n", law.title,
        percent(law.checked.fitted.rms_ratio()),
        law.checked.held_out.samples > 0 ? percent(law.checked.held_out.rms_ratio()) : "-");
    for (const std::string& reason : law.checked.reasons)
      out += (law.checked.follows ? "# limit: " : "# cannot follow: ") + reason + "\n";
    out += toml_of_keys(law, written);
  }
  if (report.relaxation) out += "\n" + toml_of_relaxation(*report.relaxation);
  return out;
}

ordered_json json_of(const FitReport& report) {
  ordered_json out{{"format", "tact-fit"},
                   {"version", 1},
                   {"follows", report.follows()},
                   {"laws", ordered_json::array()}};
  if (report.data) out["data"] = report.data->source;
  for (const FittedLaw& law : report.laws) out["laws"].push_back(json_of(law));
  out["notes"] = report.notes;
  if (const auto& r = report.relaxation) {
    ordered_json terms = ordered_json::array();
    for (const model::law::PronyTerm& t : r->terms)
      terms.push_back({{"share_ratio", t.share}, {"time_s", t.time_s}});
    out["relaxation"] = {{"terms", terms},
                         {"at_once_N", r->initial_N},
                         {"rms_ratio", r->residual_ratio},
                         {"worst_ratio", r->worst_ratio},
                         {"follows", r->is_good}};
  }
  return out;
}

}  // namespace tact::tools::fit
