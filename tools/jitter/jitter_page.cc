// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/jitter_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/report/html.h"

namespace tact::tools::jitter {
namespace {

using firmware::pc::PcRow;

constexpr const char* kStyle =
    "body{font:15px/1.45 'DejaVu Sans',Arial,sans-serif;color:#222;max-width:1060px;margin:2em "
    "auto;padding:0 1em}h1{font-size:1.5em;margin-bottom:.2em}h2{font-size:1.15em;margin:1.6em 0 "
    ".4em}table{border-collapse:collapse;width:100%}th,td{padding:.25em .6em;text-align:left;"
    "border-bottom:1px solid #ddd;vertical-align:top}td.n,th.n{text-align:right;font-variant-"
    "numeric:tabular-nums;white-space:nowrap}.stamp{display:inline-block;padding:.1em .6em;border-"
    "radius:.3em;color:#fff}.red{background:#b3261e}.green{background:#2e7d32}.unknown{background:"
    "#8a6d00}code{background:#f3f3f3;padding:.1em .3em;overflow-wrap:anywhere}svg{max-width:100%;"
    "height:auto}.note{color:#555}";

std::string row(const std::vector<std::string>& cells, const char* tag, std::size_t words) {
  std::string out = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i)
    out += fmt::format("<{0}{1}>{2}</{0}>", tag, i < words ? "" : " class=n", cells[i]);
  return out + "</tr>\n";
}

std::string series_table(const JitterResult& result) {
  std::vector<std::string> head{"us", "samples"};
  for (const Share& share : kShares) head.emplace_back(share.name);
  head.insert(head.end(), {"largest", "at, s", "tick"});
  std::string out = "<table>" + row(head, "th", 1);
  for (const NamedSeries& named : series_of(result)) {
    const auto& h = named.series->histogram;
    std::vector<std::string> cells{report::escape_html(named.title), std::to_string(h.count())};
    for (const Share& share : kShares) cells.push_back(in_us(percentile_ns(h, share.value)));
    const bool of_peer = named.key == "peer_wake";
    cells.insert(
        cells.end(),
        {in_us(h.max_ns()),
         of_peer ? "" : fmt::format("{:.3f}", seconds_into(result, named.series->max_at_ns)),
         of_peer ? "" : std::to_string(h.max_tick())});
    out += row(cells, "td", 1);
  }
  return out + "</table>\n";
}

std::string late_table(const JitterResult& result) {
  const auto late = result.sink->late_ticks();
  const std::string threshold = in_us(static_cast<std::uint64_t>(result.sink->threshold_ns()));
  std::string out = fmt::format(
      "<p>{} ticks took more than {} us from their deadline to the force; the worst {} are listed, "
      "with what the kernel counted around it, in how long a time{}.</p>\n",
      result.sink->over_threshold(), threshold, std::min<std::size_t>(late.size(), 20),
      result.has_marker ? " and marked in its trace (tact-jitter)" : "");
  if (late.empty()) return out;
  out += "<table>" + row({"kernel counted", "at, s", "tick", "us", "wake-up", "skipped"}, "th", 1);
  for (std::size_t i = 0; i < std::min<std::size_t>(late.size(), 20); ++i) {
    const TickTimes& t = late[i].times;
    out += row({report::escape_html(late[i].attribution),
                fmt::format("{:.3f}", seconds_into(result, t.due_ns)), std::to_string(t.tick),
                in_us(static_cast<std::uint64_t>(late[i].worst_ns)),
                in_us(static_cast<std::uint64_t>(t.phase(firmware::loop::Phase::kWake))),
                std::to_string(t.skipped_before)},
               "td", 1);
  }
  return out + "</table>\n";
}

std::string count(const std::optional<std::uint64_t>& value) {
  return value ? std::to_string(*value) : "not readable here";
}

std::string cost_table(const JitterResult& result) {
  const Costs& c = result.costs;
  const firmware::run::ThreadCosts& t = result.thread;
  std::string out = "<table>";
  const auto add = [&](const std::string& what, const std::string& value) {
    out += row({what, value}, "td", 1);
  };
  add("heap calls of the loop", t.heap_calls_known ? std::to_string(t.heap_calls) : "not counted");
  add("page faults, minor and major", fmt::format("{} and {}", t.minor_faults, t.major_faults));
  add("switches, its own and forced",
      fmt::format("{} and {}", t.voluntary_switches, t.involuntary_switches));
  add("migrations to another core", count(c.migrations));
  add("us ready while another ran",
      c.waited_ns ? in_us(*c.waited_ns) : std::string("not readable here"));
  add("ms taken by a hypervisor, whole core", count(c.steal_ms));
  add("system management interrupts", count(c.smi));
  std::vector<std::pair<std::uint64_t, std::string>> sources;
  for (const auto& [source, n] : c.interrupts) sources.emplace_back(n, source);
  std::sort(sources.rbegin(), sources.rend());
  for (const auto& [n, source] : sources)
    add("interrupts of its core: " + report::escape_html(source), std::to_string(n));
  return out + "</table>\n";
}

std::string pc_table(const std::vector<PcRow>& rows) {
  std::string out =
      "<table>" + row({"check", "", "found", "why it matters, and the cure"}, "th", 4);
  for (const PcRow& r : rows)
    out += row({report::escape_html(r.name),
                fmt::format("<span class='stamp {0}'>{0}</span>", name_of(r.verdict)),
                report::escape_html(r.found),
                r.cure.empty() ? std::string()
                               : fmt::format("{}<br><code>{}</code>", report::escape_html(r.why),
                                             report::escape_html(r.cure))},
               "td", 4);
  return out + "</table>\n";
}

std::string environment_table(const JitterResult& result) {
  const firmware::pc::Environment& e = result.environment;
  std::string out = "<table>";
  const std::pair<const char*, std::string> facts[] = {
      {"kernel", e.kernel_release + " " + e.kernel_version},
      {"booted with", e.boot_parameters},
      {"CPU", fmt::format("{}, microcode {}, {} online", e.cpu, e.microcode, e.cores)},
      {"clock", e.clock_source},
      {"tact", e.git_revision},
      {"compiler", e.compiler},
      {"scene", e.scene_hash.empty() ? "none" : e.scene_hash}};
  for (const auto& [what, value] : facts) out += row({what, report::escape_html(value)}, "td", 2);
  return out + "</table>\n";
}

std::string peer_sentence(const JitterResult& result) {
  if (!result.peer) return {};
  std::string out = fmt::format(
      "<p>cyclictest ran in turns with the loop, at the same priority and rate, on the same core, "
      "under the same load: <b>{}</b>.</p>\n",
      compare_with_peer(result));
  if (const auto verdict = judge_peer(result))
    out += fmt::format("<p><span class='stamp {}'>peer gate</span> {}</p>\n",
                       !verdict->turns     ? "unknown"
                       : verdict->passed() ? "green"
                                           : "red",
                       report::escape_html(verdict->sentence()));
  return out;
}

}  // namespace

std::string make_page(const JitterResult& result, const std::string& command,
                      const std::string& histogram_svg) {
  const std::size_t svg = histogram_svg.find("<svg");  // without the XML head, which HTML has not
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><title>Latency and jitter: "
      "{0}</title>\n<style>{1}</style></head><body>\n<h1>Latency and jitter</h1>\n<p>{2}</p>\n",
      report::escape_html(result.subject), kStyle, report::escape_html(make_headline(result)));
  out += result.non_rt
             ? "<p><span class='stamp red'>non-rt</span> This PC gives no hard real time; "
               "the numbers are those of this machine in this hour.</p>\n"
             : "<p><span class='stamp green'>hard real time</span></p>\n";
  if (!result.fault.empty())
    out += fmt::format("<p><span class='stamp red'>fault</span> {}</p>\n",
                       report::escape_html(result.fault));
  if (svg != std::string::npos) out += histogram_svg.substr(svg);
  out += "\n<h2>Durations</h2>\n" + series_table(result);
  out += fmt::format(
      "<p class=note>A percentile with no sample beyond it is left out. The largest is the largest "
      "of {} ticks: it bounds nothing. \"Every wake-up\" and \"deadline to force\" count each "
      "point "
      "of the grid, those that a late tick skipped too. \"Device round trip\" runs from a force "
      "handed to the device until the loop has read a sample taken after it.</p>\n",
      result.sink->ticks());
  out += peer_sentence(result);
  out += "<h2>Late ticks</h2>\n" + late_table(result);
  out += "<h2>What the kernel counted</h2>\n" + cost_table(result);
  out += "<h2>The PC</h2>\n" + pc_table(result.pc);
  out += "<h2>Where this was measured</h2>\n" + environment_table(result);
  out += fmt::format("<p class=note><code>{}</code></p>\n</body></html>\n",
                     report::escape_html(command));
  return out;
}

}  // namespace tact::tools::jitter
