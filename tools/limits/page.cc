// SPDX-License-Identifier: Apache-2.0
// The page for a safety officer: first the verdict and the limits that were tested, then a row for
// each case, then the curves. One file, nothing loaded from elsewhere, fit for printing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/limits/limit_rows.h"
#include "tools/report/html.h"

namespace tact::tools::limits {
namespace {

constexpr const char* kStyle = R"css(
body{font:15px/1.45 "DejaVu Sans",Arial,sans-serif;color:#222;max-width:1260px;margin:24px auto;padding:0 16px}
h1{font-size:24px;margin:0 0 12px}h2{font-size:18px;margin:28px 0 8px}
.verdict{padding:14px 18px;border-radius:6px;font-size:19px;font-weight:bold;color:#fff}
.pass{background:#00703c}.fail{background:#b00020}.part{background:#8a5a00}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;margin:14px 0}
.facts dt{color:#666}.facts dd{margin:0;overflow-wrap:anywhere}
table{border-collapse:collapse;width:100%}
th{text-align:left;border-bottom:2px solid #444;padding:5px 8px;vertical-align:bottom}
td{border-bottom:1px solid #ddd;padding:5px 8px;vertical-align:top}
tr{break-inside:avoid}
.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
.ok{color:#00703c;font-weight:bold}.bad{color:#b00020;font-weight:bold}
.part-text{color:#8a5a00;font-weight:bold}.quiet{color:#666}ul{margin:4px 0;padding-left:18px}
svg{max-width:100%;height:auto}
.key{display:inline-block;width:28px;height:0;border-top:3px solid;vertical-align:middle;margin:0 6px 0 18px}
)css";

const char* mark(bool holds) {
  return holds ? "<span class=ok>pass</span>" : "<span class=bad>FAIL</span>";
}

/// Right below the verdict, so that nobody takes them for tested.
std::string left_out(const LimitsReport& report) {
  if (report.not_run.empty()) return {};
  std::string out = "<p><b>Not tested:</b></p><ul>";
  for (const auto& [why, names] : report.left_out_by_why())
    out += fmt::format("<li>{}: {}</li>", report::escape_html(why), report::escape_html(names));
  return out + "</ul>\n";
}

std::string verdict(const LimitsReport& report) {
  if (report.played() == 0)
    return "<p class=\"verdict fail\">FAIL: no case was played.</p>\n" + left_out(report);
  std::size_t failed = 0;
  for (const CaseResult& r : report.cases) failed += r.verdict.passed() ? 0 : 1;
  failed += report.wall && !report.wall->passed() ? 1 : 0;
  std::string out;
  if (failed > 0)
    out = fmt::format(
        "<p class=\"verdict fail\">FAIL: {} of {} cases did not end as they must. Nobody should "
        "hold a device with these limits.</p>\n",
        failed, report.played());
  else if (report.not_run.empty())
    out = fmt::format(
        "<p class=\"verdict pass\">PASS: in all {} cases the force kept every limit. Overshoot: 0 "
        "N.</p>\n",
        report.played());
  else
    out = fmt::format(
        "<p class=\"verdict part\">{}: in these the force kept its limits. Overshoot: 0 N. {} "
        "cases were not played: of them this page shows nothing.</p>\n",
        report.result_words(), report.not_run.size());
  return out + left_out(report);
}

std::string facts(const LimitsReport& report) {
  const firmware::pc::Environment& e = report.environment;
  std::string out = "<dl class=facts>\n";
  const auto add = [&](const char* name, const std::string& value) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, report::escape_html(value));
  };
  add("Device", report.device_name + (report.simulated ? " (simulated, on simulated time)" : ""));
  add("Scene", fmt::format("{} ({}), hash {}", report.scene_name, report.scene_path, e.scene_hash));
  add("Rate", fmt::format("{:g} Hz", 1.0 / report.period_s));
  if (!report.simulated && !report.hard_real_time)
    add("Real time", fmt::format("this PC gives no hard real time; force capped to {:g} %",
                                 100.0 * report.force_share));
  if (!report.simulated)
    add("Guards", fmt::format("the watch above the loop, the runaway guard{}",
                              report.call_filter ? ", the filter on the loop's system calls"
                                                 : "; no filter on the loop's system calls"));
  add("Date", report.started);
  add("Software", fmt::format("tact {}, {}", e.git_revision, e.compiler));
  add("PC", fmt::format("{}, Linux {}", e.cpu, e.kernel_release));
  add("Command", report.command);
  return out + "</dl>\n";
}

std::string limit_row(const LimitRow& row) {
  const bool is_seen = row.largest > 0.0 || row.kept != Kept::kNotReached;
  const char* style = row.kept == Kept::kFail         ? "bad"
                      : row.kept == Kept::kNotReached ? "part-text"
                                                      : "ok";
  std::string names;
  for (const std::string& name : row.reached_by) names += (names.empty() ? "" : ", ") + name;
  std::string out = fmt::format(
      "<tr><td>{}</td><td>{}</td><td class=n>{:.4g} {}</td><td class=n>{}</td><td>{}</td>"
      "<td><span class={}>{}</span></td></tr>\n",
      row.name, row.key, row.limit, row.unit,
      is_seen ? fmt::format("{:.4g} {}", row.largest, row.unit) : "-", names.empty() ? "-" : names,
      style, kept_words(row.kept));
  for (const TighterLimit& t : row.tighter)
    out += fmt::format(
        "<tr><td class=quiet>made tighter in {}</td><td></td><td class=n>{:.4g} {}</td>"
        "<td class=n>{:.4g} {}</td><td></td><td>{}</td></tr>\n",
        t.case_name, t.limit, row.unit, t.largest, row.unit, mark(t.holds));
  return out;
}

std::string limits_table(const LimitsReport& report) {
  std::string out =
      "<h2>Limits and what was tested of them</h2>\n<table><tr><th>Limit</th><th>Key in the scene"
      "</th><th class=n>Limit</th><th class=n>Largest seen</th><th>Reached by</th><th>Kept</th>"
      "</tr>\n";
  for (const LimitRow& row : limit_rows(report)) out += limit_row(row);
  const model::Limits& l = report.limits;
  return out +
         fmt::format(
             "</table>\n<p class=quiet>Not reached: no case that is there to drive to this limit "
             "was "
             "played, so nothing is said of it. A case that makes a limit tighter is judged by the "
             "tighter one, in a row of its own. Tool no faster than {:g} m/s, within a cylinder of "
             "{:g} m radius and {:g} m half length; beyond, the force fades to zero in 50 ms. The "
             "energy budget fills again with {:g} W.</p>\n",
             l.speed_mps, l.workspace_radius_m, l.workspace_half_length_m, l.recovery_W);
}

bool is_told(const LimitsReport& report, const CaseVerdict& v) {
  return !report.simulated && opens_line(v.subject);
}

std::string tightened(const model::Limits& here, const model::Limits& all) {
  std::string out;
  if (here.power_W < all.power_W) out += fmt::format(" Here at most {:.3g} W.", here.power_W);
  if (here.energy_J < all.energy_J) out += fmt::format(" Here at most {:.3g} J.", here.energy_J);
  if (here.continuous_force_N < all.continuous_force_N)
    out += fmt::format(" Here at most {:.3g} N RMS over {:g} s.", here.continuous_force_N,
                       here.thermal_time_s);
  return out;
}

/// Four digits, and none of them an exponent.
std::string plain(double value) {
  return value < 1e4 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

std::string case_row(const CaseVerdict& v, const LimitsReport& report) {
  std::string broken;
  for (const Check& c : v.checks)
    if (!c.holds) broken += fmt::format("<li class=bad>{}</li>", report::escape_html(c.sentence));
  if (!broken.empty()) broken = "<ul>" + broken + "</ul>";
  const std::string told = is_told(report, v)
                               ? fmt::format(" <b>{}.</b>", report::escape_html(kToldInSoftware))
                               : std::string();
  const auto zero = [](const std::optional<double>& s) {
    return s ? fmt::format("{:.0f} ms", 1e3 * *s) : std::string("-");
  };
  const auto& allowed = v.subject.expected.zero_within_s;
  return fmt::format(
      "<tr><td><b>{}</b></td><td>{}{}{}</td><td class=n>{} N</td><td class=n>{:.4g} N</td>"
      "<td class=n>{:.3g} N</td><td class=n>{}</td><td class=n>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td></tr>\n",
      v.subject.name, report::escape_html(v.subject.what),
      tightened(v.limits, report.limits) + told, broken, plain(v.worst.commanded_N),
      v.worst.force_N, v.overshoot_N, zero(v.worst.zero_s),
      allowed ? fmt::format("{:.0f} ms", std::floor(1e3 * *allowed)) : "-", v.acted_words(),
      v.fault == Fault::kNone ? "-" : model::describe(v.fault).name, mark(v.passed()));
}

std::string case_rows(const LimitsReport& report) {
  if (report.cases.empty()) return {};
  std::string out =
      "<h2>Cases</h2>\n<table><tr><th>Case</th><th>What happens</th><th class=n>Commanded</th>"
      "<th class=n>Written</th><th class=n>Over&shy;shoot</th><th class=n>Zero after</th>"
      "<th class=n>Allowed</th><th>Stages that acted</th><th>Fault that "
      "latched</th><th></th></tr>\n";
  for (const CaseResult& r : report.cases) out += case_row(r.verdict, report);
  out += "</table>\n";
  return out +
         "<p class=quiet>Commanded and written: largest of the case. Zero after: from the cause to "
         "zero force and torque that last as long as the cause. Allowed: 0 where the force must be "
         "gone in the tick of the cause; else the "
         "time of the fade, of the way out of the workspace or of the late ticks, and some ticks. "
         "A fault that has latched lets no force through until a person resets and arms "
         "again.</p>\n";
}

std::string wall_section(const LimitsReport& report) {
  if (!report.wall) return {};
  std::string out = "<h2>A wall that is too stiff</h2>\n<ul>";
  for (const Check& c : report.wall->checks)
    out += fmt::format("<li>{} {}</li>", mark(c.holds), report::escape_html(c.sentence));
  return out + fmt::format(
                   "</ul>\n<p class=quiet>A light hand (200 N/m) presses a wall through the whole "
                   "loop, stiffer each time by a quarter. The device alone, without its friction "
                   "and the hand, bears {:.4g} N/m. With and without: the passivity stage of the "
                   "gate. Bounded: the "
                   "tool does not swing wider and wider, but it may swing for ever. At rest: it "
                   "swings by "
                   "0.1 mm or less in the last half second of 4 s.</p>\n",
                   report.wall->theory_N_per_m);
}

/// A drawing without its XML head, to stand within the page; its names made its own.
std::string inlined(const std::string& svg, std::size_t number) {
  const std::size_t begin = svg.find("<svg");
  std::string out = begin == std::string::npos ? std::string() : svg.substr(begin);
  const std::string own = fmt::format("d{}_", number);
  for (const std::string name : {"id=\"", "id='", "href='#", "href=\"#", "url(#"})
    for (std::size_t at = out.find(name); at != std::string::npos;
         at = out.find(name, at + name.size() + own.size()))
      out.insert(at + name.size(), own);
  return out;
}

std::string how_it_was_tested(const LimitsReport& report) {
  const bool told = std::any_of(report.cases.begin(), report.cases.end(),
                                [&](const CaseResult& r) { return is_told(report, r.verdict); });
  return fmt::format(
      "<h2>How it was tested</h2>\n<p>Each case arms the controller that drives the device, waits "
      "until its force is fully let in, and commands a force as a tissue would. The force takes "
      "the way of every force: contact, gate, device. The limits are judged from what the device "
      "was handed, by sums of the test's own; the gate is not asked.{}</p>\n"
      "<p>What it does not show: that the device makes the force it is handed, that its emergency "
      "stop cuts its power, and what a person feels.{} A PC is not a safety device: it provides "
      "diagnostics and a controlled stop. A device that can hurt needs an emergency stop that "
      "removes power without asking a PC.</p>\n</body></html>\n",
      report.simulated ? ""
                       : " Missing samples, late ticks and faults are made in software, between "
                         "controller and device.",
      told ? " Nor that a contact of the emergency stop or the dead-man switch is seen: its fault "
             "was told in software, the contact was not opened. Press it by hand."
           : "");
}

}  // namespace

std::string page_html(const LimitsReport& report, const std::vector<std::string>& svg) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=en><head><meta charset=utf-8>"
      "<meta name=viewport content=\"width=device-width\"><title>tact-limits: {}</title>"
      "<style>{}</style></head><body>\n<h1>Safety-limited force output: test report</h1>\n",
      report.result_words(), kStyle);
  out += verdict(report) + facts(report) + limits_table(report) + case_rows(report);
  if (!svg.empty() && !report.cases.empty())
    out +=
        "<h2>Curves</h2>\n<p><span class=key style=\"border-color:#999;margin-left:0\"></span>"
        "commanded<span class=key style=\"border-color:#56B4E9;border-width:5px\"></span>let "
        "through by the gate<span class=key style=\"border-color:#000;border-width:2px\"></span>"
        "written to the device<span class=key style=\"border-color:#b00020;border-top-style:dashed"
        "\"></span>limit; dotted: the cause</p>\n" +
        inlined(svg.front(), 0);
  out += wall_section(report);
  if (report.wall && svg.size() == (report.cases.empty() ? 1u : 2u)) out += inlined(svg.back(), 1);
  return out + how_it_was_tested(report);
}

}  // namespace tact::tools::limits
