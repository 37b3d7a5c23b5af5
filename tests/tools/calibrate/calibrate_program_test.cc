// SPDX-License-Identifier: Apache-2.0
// tact-calibrate as a person meets it: its options, and what it refuses before anything moves.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/program.h"

namespace tact::tests::calibrate_program_test {

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

void expect_refusal(const Outcome& outcome, const std::string& message) {
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("tact-calibrate: " + message), std::string::npos) << outcome.output;
}
Outcome calibrate(const std::string& arguments) { return run_program("tact-calibrate", arguments); }
/// On a terminal of its own, where a person types `answer`.
Outcome on_terminal(const std::string& arguments, const std::string& answer) {
  const std::string program = tests::program_path("tact-calibrate") + " " + arguments;
  return run_command("printf '" + answer + "\\n' | script -qec '" + program + "' /dev/null");
}

TEST(CalibrateProgram, ReportsItsOptions) {
  const Outcome outcome = calibrate("--help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"DEVICE", "--masses-kg", "--poses", "at most 6 N", "--set"})
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
}

TEST(CalibrateProgram, RefusesWhatItCannotDo) {
  const std::string falcon = "falcon " + kLiver;
  expect_refusal(calibrate(""), "DEVICE");
  expect_refusal(calibrate("omega " + kLiver), "DEVICE");
  expect_refusal(calibrate(falcon + " --poses 1"), "--poses");
  expect_refusal(calibrate(falcon + " --poses 11"), "--poses");
  expect_refusal(calibrate(falcon + " --masses-kg 0.1"), "--masses-kg");
  expect_refusal(calibrate(falcon + " --masses-kg 0.1 0.6"), "--masses-kg");
  expect_refusal(calibrate(falcon + " --masses-kg 0.1 -0.1"), "--masses-kg");
}

TEST(CalibrateProgram, MovesNothingWithoutAPersonAtATerminal) {
  const std::string message =
      "asks before anything moves, so it needs a terminal: start it from one";
  expect_refusal(calibrate("falcon " + kLiver + " </dev/null"), message);
  expect_refusal(
      run_command("echo yes | " + tests::program_path("tact-calibrate") + " falcon " + kLiver),
      message);
}

TEST(CalibrateProgram, MovesNothingBeforeThePersonAgrees) {
  for (const char* answer : {"no", "", "y", "Yes", "yes please"})
    expect_refusal(on_terminal("falcon " + kLiver, answer), "not agreed to: nothing moved");
  expect_refusal(on_terminal("falcon /no/such/scene.toml", "yes"), "/no/such/scene.toml");
  // No Falcon is there, with any device plugged in.
  const Outcome agreed =
      on_terminal("falcon " + kLiver + " --set device.falcon.bus_path=\\\"99-9\\\"", "yes");
  EXPECT_EQ(agreed.output.find("not agreed to"), std::string::npos) << agreed.output;
  EXPECT_NE(agreed.status, 0);
}

}  // namespace tact::tests::calibrate_program_test
