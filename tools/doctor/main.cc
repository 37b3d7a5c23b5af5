// SPDX-License-Identifier: Apache-2.0
// tact-doctor: is this PC fit for hard real time, and if not, what is the remedy?
#include <fmt/color.h>
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "firmware/pc/pc_check.h"
#include "firmware/pc/rt_setup.h"
#include "hal/registry/open_device.h"
#include "model/io/json.h"
#include "model/io/program/within.h"
#include "tools/program/program.h"
#include "tools/program/script.h"

namespace {

using namespace tact::firmware::pc;
using tact::model::Error;

struct Options {
  std::string root;
  int core = -1;
  int stalls_s = 0;
  bool as_json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("--core", o.core,
                 "CPU core that the loop will use (default: an isolated one, or the last)")
      ->check(tact::model::io::within(0, CPU_SETSIZE - 1));
  app.add_option("--root", o.root,
                 "look below this folder instead, at a copy of another PC's proc/, sys/ and dev/");
  app.add_option(
         "--stalls", o.stalls_s,
         "instead, as root and while no loop runs: does the hardware hold the CPU (SMI)? by "
         "the kernel's tracer hwlat, for so long, s")
      ->check(tact::model::io::within(1, 86400));
  app.add_flag("--json", o.as_json, "print one JSON document");
}

/// In this colour on a terminal, else plain.
fmt::text_style style_of(Verdict verdict) {
  if (isatty(STDOUT_FILENO) == 0) return {};
  return fg(verdict == Verdict::kGreen ? fmt::terminal_color::green
            : verdict == Verdict::kRed ? fmt::terminal_color::red
                                       : fmt::terminal_color::yellow);
}

void print_table(const std::vector<PcRow>& rows) {
  std::size_t width = 0;
  for (const PcRow& row : rows) width = std::max(width, row.name.size());
  for (const PcRow& row : rows) {
    const auto verdict = fmt::styled(name_of(row.verdict), style_of(row.verdict));
    fmt::print("{:{}}  {:7}  {}\n", row.name, width, verdict, row.found);
    if (row.verdict == Verdict::kGreen) continue;
    fmt::print("{:{}}           why:  {}\n", "", width, row.why);
    fmt::print("{:{}}           remedy: {}\n", "", width, row.remedy);
  }
  const auto count = [&](Verdict verdict) {
    return std::ranges::count(rows, verdict, &PcRow::verdict);
  };
  fmt::print("{} green, {} red, {} unknown\n", count(Verdict::kGreen), count(Verdict::kRed),
             count(Verdict::kUnknown));
}

}  // namespace

int main(int argc, char** argv) {
  tact::tools::program::Program program(
      "tact-doctor",
      "Is this PC fit for hard real time? One row a check: green, red or unknown, why it matters, "
      "and the\nremedy as a command. Opens no device and changes nothing.",
      "ns: nanoseconds, us: microseconds. Unknown: not reported by this PC; only red fails.");
  Options options;
  add_options(program.options(), options);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (options.stalls_s > 0)
    return program.fail(tact::tools::program::become_script(
        "tact-jitter-late", {"--hwlat", std::to_string(options.stalls_s)}, "tact-tools"));
  if (!options.root.empty() && !std::filesystem::is_directory(options.root + "/proc"))
    return program.fail(Error{options.root + ": has no proc/ below it; name a folder that has"});
  PcQuestion question{.files = PcFiles(options.root),
                      .usb = tact::hal::registry::usb_parts(),
                      .core = options.core};
  // Of a copy the rows choose by its own files.
  if (options.root.empty()) question.core = choose_core({.core = options.core});
  const auto rows = check_pc(question);
  if (options.as_json)
    fmt::print("{}\n", tact::model::io::text_of(nlohmann::json{{"format", "tact-doctor"},
                                                               {"version", 1},
                                                               {"core", core_in_question(question)},
                                                               {"checks", to_json(rows)}},
                                                2));
  else
    print_table(rows);
  // Unknown does not fail: a virtual machine or a container does not report everything.
  return std::ranges::count(rows, Verdict::kRed, &PcRow::verdict) == 0 ? 0 : 1;
}
