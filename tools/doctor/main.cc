// SPDX-License-Identifier: Apache-2.0
// tact-doctor: is this PC fit for hard real time, and if not, what is the cure?
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "firmware/pc/rt_setup.h"
#include "model/io/within.h"
#include "tools/doctor/doctor_table.h"
#include "tools/program/program.h"

namespace {

using namespace tact::firmware::pc;  // NOLINT(google-build-using-namespace): the rows it shows
using tact::model::Error;

struct Options {
  std::string root;
  int core = -1;
  bool as_json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("--core", o.core,
                 "CPU core that the loop will use (default: an isolated one, or the last)")
      ->check(tact::model::io::within(0, CPU_SETSIZE - 1));
  app.add_option("--root", o.root,
                 "look below this folder instead, at a copy of another PC's proc/, sys/ and dev/");
  app.add_flag("--json", o.as_json, "print one JSON document");
}

}  // namespace

int main(int argc, char** argv) {
  tact::tools::program::Program program(
      "tact-doctor",
      "Is this PC fit for hard real time? One row a check: green, red or unknown, why it matters, "
      "and the\ncure as a command. Reads /proc, /sys and /dev; changes nothing, opens no device.",
      "ns: nanoseconds, us: microseconds. Unknown is what this PC does not tell; only red fails.");
  Options options;
  add_options(program.options(), options);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (!options.root.empty() && !std::filesystem::is_directory(options.root + "/proc"))
    return program.fail(Error{options.root + ": has no proc/ below it; name a folder that has"});
  PcQuestion question{.files = PcFiles(options.root), .core = options.core};
  if (options.root.empty()) question.core = choose_core({.core = options.core});
  const auto rows = check_pc(question);
  if (options.as_json)
    fmt::print("{}\n",
               nlohmann::json{{"core", core_in_question(question)}, {"checks", to_json(rows)}}.dump(
                   2, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    fmt::print("{}", tact::tools::doctor::make_doctor_table(rows, isatty(STDOUT_FILENO) != 0));
  const bool any_red = std::any_of(rows.begin(), rows.end(),
                                   [](const PcRow& row) { return row.verdict == Verdict::kRed; });
  return any_red ? 1 : 0;
}
