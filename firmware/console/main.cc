// SPDX-License-Identifier: Apache-2.0
// tactctl: arms, disarms, resets, stops or asks the tactd that runs a scene.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>

#include "firmware/console/control_client.h"
#include "firmware/console/control_name.h"
#include "firmware/console/say.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "model/io/program/within.h"
#include "model/io/socket_file.h"

namespace {

constexpr const char* kServices = "/run/tact";  // RuntimeDirectory of tactd@.service

/// The folder of the caller's own tactd, or of the one that runs as a service.
tact::model::Result<std::string> folder_of(const std::string& scene_path) {
  using tact::firmware::console::find_controls;
  auto own = tact::model::io::runtime_directory();
  const bool is_own = own && !find_controls(*own, scene_path).empty();
  // One that may not be read has its reason in the message (control_client.h).
  const bool closed = access(kServices, R_OK) != 0 && errno == EACCES;
  if (!is_own && (closed || !find_controls(kServices, scene_path).empty()))
    return std::string(kServices);
  return own;
}

/// Appends KEY=VALUE to the word "set", "KEY VALUE" as well; the number of an event.
std::optional<tact::model::Error> add_numbers(std::string& word,
                                              const std::vector<std::string>& numbers) {
  const bool is_event = word == "event";
  if ((is_event || word == "set") == numbers.empty())
    return tact::model::Error{!numbers.empty() ? word + " takes no numbers"
                              : is_event       ? "event needs a number from 1 to 255"
                                               : "set needs KEY=VALUE, or KEY VALUE"};
  bool is_value = false;
  for (const std::string& number : numbers) {
    word += (is_value ? '=' : ' ') + number;
    is_value = !is_event && !is_value && number.find('=') == std::string::npos;
  }
  if (is_value) return tact::model::Error{numbers.back() + " has no value"};
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tact::firmware;
  tact::model::io::watch_standard_output("tactctl");
  tact::model::io::report_uncaught("tactctl");
  CLI::App app{
      "tactctl: asks the tactd that runs SCENE, on this computer and of the same user (or as "
      "root).\n"
      "Exit status: 0 done, 1 refused, 2 bad usage, or no such tactd."};
  console::ControlQuestion question;
  app.add_option("SCENE", question.scene_path, "the scene file that tactd was given")->required();
  app.add_option("WORD", question.word,
                 "arm: force, after the words \"ready, force is off\"; disarm: no force, and ready "
                 "to be armed again; reset: leave a stop whose cause is gone; stop: force to zero, "
                 "then end; status: how it is; set: other numbers of the law, used as soon as the "
                 "tool is out of contact; event: a number into the record of the next tick")
      ->required()
      ->check(CLI::IsMember({"arm", "disarm", "reset", "stop", "status", "set", "event"}));
  std::vector<std::string> numbers;
  app.add_option(
      "NUMBERS", numbers,
      "with set: KEY=VALUE, or KEY VALUE; tactd SCENE --parameters lists the keys; with event: "
      "1 to 255");
  app.add_option("--pid", question.process, "of several tactds that run it, the one of this pid")
      ->check(tact::model::io::within(1, 4'194'304));
  app.add_option("--folder", question.folder,
                 "runtime folder of tactd's user (default: tact in XDG_RUNTIME_DIR, or "
                 "/tmp/tact-UID; else /run/tact of the service)");
  if (const auto status = tact::model::io::parse_command_line(
          app, "tactctl", argc, argv, [&] { return add_numbers(question.word, numbers); }))
    return *status;
  const auto folder = question.folder.empty() ? folder_of(question.scene_path) : question.folder;
  if (folder) question.folder = *folder;
  const auto answer = folder ? console::ask_tactd(question) : folder.error();
  if (!answer) {
    console::say(stderr, "tactctl: {}\n", answer.error().message);
    return 2;
  }
  console::say(answer->done ? stdout : stderr, "{}\n", answer->message);
  return answer->done ? 0 : 1;
}
