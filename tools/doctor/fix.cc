// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/fix.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <grp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

#include "model/io/input_file.h"
#include "tools/doctor/undo_store.h"
#include "tools/program/run_program.h"

namespace tact::tools::doctor {
namespace {

using model::Error;
using model::Result;

constexpr int kDone = 0, kNotAll = 1;

std::string line_of(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

void tell(const std::string& sentence) { fmt::print(stderr, "tact-doctor: {}\n", sentence); }

/// True: go on. False: the answer was no. An error: there is nobody to ask, or this is not root.
Result<bool> may_go_on(const FixOptions& options) {
  // Below another root nothing of this PC is touched.
  if (options.root.empty() && geteuid() != 0)
    return Error{"only root may change this PC: sudo tact-doctor, or --dry-run to look"};
  if (options.yes) return true;
  if (isatty(STDIN_FILENO) == 0)
    return Error{"nobody is there to be asked: say --yes, or --dry-run to look"};
  fmt::print("Do all of this? [y/N] ");
  std::fflush(stdout);
  std::array<char, 16> answer{};
  return std::fgets(answer.data(), answer.size(), stdin) != nullptr &&
         (answer[0] == 'y' || answer[0] == 'Y');
}

/// False, with the reason told, where it failed.
bool run(const std::vector<std::string>& words, const FixOptions& options) {
  if (!options.root.empty()) {
    fmt::print("not run, as --root is another PC: {}\n", line_of(words));
    return true;
  }
  auto scratch = program::ScratchFolder::make("tact-doctor");
  if (!scratch) return tell(scratch.error().sentence), false;
  const auto ran = program::run_program(
      {.program = words.front(),
       .arguments = {words.begin() + 1, words.end()},
       .directory = "/",
       .log_path = scratch->file("log"),
       .package = words.front() == "update-grub" ? "grub2-common" : "passwd systemd",
       .environment = {}});
  if (ran) return true;
  tell(ran.error().sentence);
  scratch->keep();  // the sentence names a file in it
  return false;
}

/// Where the file stands as it should, its own place or a package's; empty: nowhere.
std::string place_of(const FixOptions& options, const DropIn& file) {
  std::vector<std::string> places{file.path};
  places.insert(places.end(), file.packaged.begin(), file.packaged.end());
  for (const std::string& path : places) {
    const auto now = model::io::read_file(options.root + path);
    if (now && *now == file.content) return options.root + path;
  }
  return {};
}

/// What is to be written and run; the rest of the plan stands.
FixPlan what_is_left(const FixPlan& plan, const FixOptions& options) {
  FixPlan rest{.files = {}, .commands = {}, .left = plan.left};
  for (const DropIn& file : plan.files)
    if (place_of(options, file).empty()) rest.files.push_back(file);
  for (const FixCommand& command : plan.commands)
    if (command.file.empty() ||
        std::ranges::find(rest.files, command.file, &DropIn::path) != rest.files.end())
      rest.commands.push_back(command);
  return rest;
}

void print_plan(const FixPlan& all, const FixPlan& rest, const FixOptions& options) {
  for (const DropIn& file : all.files)
    if (const std::string place = place_of(options, file); !place.empty())
      fmt::print("{} is up to date\n", place);
  for (const DropIn& file : rest.files)
    fmt::print("--- {}{}\n{}", options.root, file.path, file.content);
  for (const FixCommand& command : rest.commands) fmt::print("+ {}\n", line_of(command.words));
  if (!rest.left.empty()) fmt::print("left to you:\n");
  for (const std::string& row : rest.left) fmt::print("  {}\n", row);
}

/// Takes back what runs before, or after, the files are back.
bool run_back(UndoStore& store, const FixOptions& options, bool last) {
  bool good = true;
  const std::vector<FixCommand> commands = store.commands();
  for (auto command = commands.rbegin(); command != commands.rend(); ++command) {
    if (command->back_last != last) continue;
    const group* const haptics = getgrnam("haptics");
    // Somebody has joined since: without the group those people lose their devices.
    const bool is_used = haptics != nullptr && *haptics->gr_mem != nullptr;
    if (!command->back.empty() && command->back.front() == "groupdel" && is_used)
      fmt::print("the group haptics has members, so it stays\n");
    else if (!command->back.empty() && !run(command->back, options)) {
      good = false;
      continue;
    }
    if (const auto failed = store.forget(*command)) tell(failed->sentence), good = false;
  }
  return good;
}

}  // namespace

FixPeople people_of_this_pc() {
  FixPeople people;
  const char* const user = std::getenv("SUDO_USER");
  const group* const haptics = getgrnam("haptics");
  people.has_group = haptics != nullptr;
  if (user == nullptr || std::string_view(user) == "root") return people;
  char** member = haptics == nullptr ? nullptr : haptics->gr_mem;
  while (member != nullptr && *member != nullptr && std::string_view(*member) != user) ++member;
  if (member == nullptr || *member == nullptr) people.user = user;
  return people;
}

Result<int> fix(const FixPlan& plan, const FixOptions& options) {
  auto store = UndoStore::open(options.root);
  if (!store) return store.error();
  const FixPlan rest = what_is_left(plan, options);
  print_plan(plan, rest, options);
  if (rest.files.empty() && rest.commands.empty()) {
    fmt::print("nothing to write; what is up to date holds from the next boot\n");
    return kDone;
  }
  if (options.dry_run) return kDone;
  const auto go = may_go_on(options);
  if (!go) return go.error();
  if (!*go) return kNotAll;
  bool good = true;
  // Files first, as update-grub and systemctl read them.
  for (const DropIn& file : rest.files) {
    if (const auto failed = store->write(file)) {
      tell(failed->sentence);
      return kNotAll;
    }
  }
  for (const FixCommand& command : rest.commands) {
    // Noted only if it ran: --undo must not take back what never was.
    const bool ran = run(command.words, options);
    if (ran)
      if (const auto failed = store->note(command)) tell(failed->sentence), good = false;
    good = good && ran;
  }
  fmt::print("{}; boot, and ask tact-doctor again. tact-doctor --undo takes this back\n",
             good ? "done" : "not all was done");
  return good ? kDone : kNotAll;
}

Result<int> undo(const FixOptions& options) {
  auto store = UndoStore::open(options.root);
  if (!store) return store.error();
  if (store->is_empty()) {
    fmt::print("nothing to take back\n");
    return kDone;
  }
  for (const KeptFile& file : store->files())
    fmt::print("{}{}: {}\n", options.root, file.path, file.existed ? "as it was" : "goes");
  for (const FixCommand& command : store->commands()) fmt::print("+ {}\n", line_of(command.back));
  if (options.dry_run) return kDone;
  const auto go = may_go_on(options);
  if (!go) return go.error();
  if (!*go) return kNotAll;
  // Services stop while their unit file is still there; reloading comes when the files are back.
  bool good = run_back(*store, options, false);
  // The newest first, as in any undo.
  for (std::size_t i = store->files().size(); i-- > 0;) {  // what is back leaves the list
    const std::string path = options.root + store->files()[i].path;
    const auto back = store->put_back(i);
    if (!back) tell(back.error().sentence);
    if (back && !*back)
      tell(path + " was edited after --fix, so it stays; remove it, then undo again");
    good = good && back && *back;
  }
  good = run_back(*store, options, true) && good;
  if (good) store->forget();
  fmt::print("{}\n", good ? "all is as it was; boot" : "not all is as it was");
  return good ? kDone : kNotAll;
}

}  // namespace tact::tools::doctor
