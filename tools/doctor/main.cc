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
#include "model/io/json.h"
#include "model/io/program/within.h"
#include "tools/doctor/doctor_table.h"
#include "tools/doctor/fix.h"
#include "tools/program/program.h"

namespace {

using namespace tact::firmware::pc;
using namespace tact::tools::doctor;
using tact::model::Error;

struct Options {
  std::string root;
  int core = -1;
  bool as_json = false, fix = false, undo = false;
  FixOptions how;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("--core", o.core,
                 "CPU core that the loop will use (default: an isolated one, or the last)")
      ->check(tact::model::io::within(0, CPU_SETSIZE - 1));
  app.add_option(
      "--root", o.root,
      "look below this folder instead, at a copy of another PC's proc/, sys/ and dev/; --fix "
      "and --undo write below it and run no command (for tests)");
  auto* json = app.add_flag("--json", o.as_json, "print one JSON document");
  auto* fix = app.add_flag("--fix", o.fix,
                           "do what red rows advise, by files of its own below /etc, and say what "
                           "is left; asks first");
  fix->excludes(json);
  app.add_flag("--undo", o.undo, "take back what --fix did, byte for byte; asks first")
      ->excludes(fix)
      ->excludes(json);
  app.add_flag("--dry-run", o.how.dry_run, "with --fix or --undo: say it, and change nothing");
  app.add_flag("--yes", o.how.yes, "with --fix or --undo: do not ask");
}

int mend(const tact::tools::program::Program& program, const PcQuestion& question,
         const std::vector<PcRow>& rows, const Options& options) {
  const FixPeople people =
      // A copy of another PC has no users of ours.
      options.root.empty() ? people_of_this_pc() : FixPeople{.user = "", .has_group = true};
  const auto ended =
      options.undo ? undo(options.how) : fix(plan_fix(question, rows, people), options.how);
  return ended ? *ended : program.fail(ended.error());
}

}  // namespace

int main(int argc, char** argv) {
  tact::tools::program::Program program(
      "tact-doctor",
      "Is this PC fit for hard real time? One row a check: green, red or unknown, why it matters, "
      "and the\ncure as a command. Opens no device; changes nothing without --fix.",
      "ns: nanoseconds, us: microseconds. Unknown is what this PC does not tell; only red fails.");
  Options options;
  add_options(program.options(), options);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (!options.root.empty() && !std::filesystem::is_directory(options.root + "/proc"))
    return program.fail(Error{options.root + ": has no proc/ below it; name a folder that has"});
  PcQuestion question{.files = PcFiles(options.root), .core = options.core};
  // Of a copy the rows choose by its own files.
  if (options.root.empty()) question.core = choose_core({.core = options.core});
  options.how.root = options.root;
  if ((options.how.dry_run || options.how.yes) && !options.fix && !options.undo)
    return program.fail(Error{"--dry-run and --yes belong to --fix or --undo"});
  const auto rows = check_pc(question);
  if (options.fix || options.undo) return mend(program, question, rows, options);
  if (options.as_json)
    fmt::print("{}\n", tact::model::io::text_of(nlohmann::json{{"format", "tact-doctor"},
                                                               {"version", 1},
                                                               {"core", core_in_question(question)},
                                                               {"checks", to_json(rows)}},
                                                2));
  else
    fmt::print("{}", make_doctor_table(rows, isatty(STDOUT_FILENO) != 0));
  const bool any_red = std::any_of(rows.begin(), rows.end(),
                                   [](const PcRow& row) { return row.verdict == Verdict::kRed; });
  // Unknown does not fail: a virtual machine or a container does not tell everything.
  return any_red ? 1 : 0;
}
