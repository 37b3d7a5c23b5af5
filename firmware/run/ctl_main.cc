// SPDX-License-Identifier: Apache-2.0
// tactctl: arms, resets, stops or asks the tactd that runs a scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "firmware/run/control_client.h"
#include "firmware/run/say.h"
#include "firmware/telemetry/telemetry_socket.h"
#include "model/io/within.h"

int main(int argc, char** argv) {
  using namespace tact::firmware;
  CLI::App app{
      "tactctl: asks the tactd that runs SCENE, on this computer and of the same user (or as "
      "root).\n"
      "Exit status: 0 done, 1 refused, 2 bad usage, or no such tactd."};
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("tactctl: ") + error.what() + "; see tactctl --help\n";
  });
  run::ControlQuestion question;
  app.add_option("SCENE", question.scene_path, "the scene file that tactd was given")->required();
  app.add_option("WORD", question.word,
                 "arm: force, after the words \"ready, force is off\"; reset: leave a stop whose "
                 "cause is gone; stop: force to zero, then end; status: how it is")
      ->required()
      ->check(CLI::IsMember({"arm", "reset", "stop", "status"}));
  app.add_option("--pid", question.process, "of several tactds that run it, the one of this pid")
      ->check(tact::model::io::within(1, 4'194'304));
  app.add_option("--folder", question.folder,
                 "runtime folder of tactd's user (default: tact in XDG_RUNTIME_DIR, or "
                 "/tmp/tact-UID)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto folder = question.folder.empty() ? telemetry::runtime_directory() : question.folder;
  if (folder) question.folder = *folder;
  const auto answer = folder ? run::ask_tactd(question) : folder.error();
  if (!answer) {
    run::say(stderr, "tactctl: {}\n", answer.error().sentence);
    return 2;
  }
  run::say(answer->done ? stdout : stderr, "{}\n", answer->sentence);
  return answer->done ? 0 : 1;
}
