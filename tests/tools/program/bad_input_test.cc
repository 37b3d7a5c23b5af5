// SPDX-License-Identifier: Apache-2.0
// Every program against numbers that are none, and against files of the wrong kind.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace tact::tools::program::bad_input_test {

namespace fs = std::filesystem;

using tests::Outcome;
using tests::program_path;
using tests::run_command;
using tests::run_program;

const std::string kScene = TACT_SOURCE_DIR "/model/scenes/liver.toml";
const std::vector<std::string> kPrograms{
    "tactd",          "tact-view",          "tact-jitter",        "tact-lab fit",
    "tact-lab plan",  "tact-lab chart",     "tact-lab condense",  "tact-mesh",
    "tact-doctor",    "tact-limits",        "tact-verify",        "tactctl",
    "tact-calibrate", "tact-lab reference", "tact-lab stability", "tact-lab new-scene",
    "tact-lab sweep"};

class BadInput : public testing::Test {
 protected:
  BadInput() : folder_(testing::TempDir() + "tact-bad-" + std::to_string(getpid())) {
    fs::create_directories(folder_);
  }
  ~BadInput() override { fs::remove_all(folder_); }

  /// No crash, no wait, status 2, and one line that holds `words`.
  void refuses(const std::string& program, const std::string& arguments, const std::string& words) {
    const Outcome outcome =
        run_command("(timeout 60 " + program_path(program) + " " + arguments + " </dev/null)");
    EXPECT_EQ(outcome.status, 2) << program << " " << arguments << ": " << outcome.output;
    EXPECT_NE(outcome.output.find(words), std::string::npos)
        << program << " " << arguments << ": " << outcome.output;
  }

  const std::string folder_;
};

/// The options of --help that take a number.
std::vector<std::string> number_options(const std::string& program) {
  std::istringstream lines(run_program(program, "--help").output);
  std::vector<std::string> out;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t option = line.find("--");
    const bool number = line.find(" FLOAT") != std::string::npos ||
                        line.find(" INT") != std::string::npos ||
                        line.find(" UINT") != std::string::npos;
    if (number && option != std::string::npos && option < 10)
      out.push_back(line.substr(option, line.find_first_of(" ,", option) - option));
  }
  return out;
}

TEST_F(BadInput, EveryProgramReportsItsVersionAndWhatBuiltIt) {
  for (const std::string& line : kPrograms) {
    const std::string program = line.substr(0, line.find(' '));
    const Outcome outcome = run_program(program, "--version");
    EXPECT_EQ(outcome.status, 0) << program;
    EXPECT_TRUE(std::regex_match(
        outcome.output, std::regex(program + R"( \d+\.\d+\.\d+(-rc\d+)? \(\S+\), compiler .+\n)")))
        << outcome.output;
  }
}

// Its name is read after main(), where no object of main() is left.
TEST_F(BadInput, EveryProgramReportsThatItsOutputIsNotTaken) {
  for (const std::string& line : kPrograms) {
    const std::string program = line.substr(0, line.find(' '));
    const Outcome outcome = run_command("(" + program_path(program) + " --help >/dev/full)");
    EXPECT_EQ(outcome.status, 2) << program;
    EXPECT_EQ(outcome.output,
              program +
                  ": standard output cannot be written: No space left on device; check where "
                  "it goes\n");
  }
}

TEST_F(BadInput, AnEmptyArgumentIsRefusedByEveryProgram) {
  for (const std::string& program : kPrograms)
    for (const char* empty : {"''", "--out=", "--json ''"}) refuses(program, empty, "is empty");
}

TEST_F(BadInput, NonFiniteNumbersAreRefusedByEveryOption) {
  std::size_t options = 0;
  for (const std::string& program : kPrograms)
    for (const std::string& option : number_options(program)) {
      ++options;
      for (const char* word : {"nan", "inf", "1e400", "x"})
        refuses(program, option + " " + word, option);
    }
  EXPECT_GE(options, 20u) << "the options are no longer found in --help";
}

TEST_F(BadInput, AFolderOrPipeWhereAFileBelongsGetsAMessage) {
  const std::string pipe = folder_ + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& [path, words] :
       {std::pair{folder_, "this is a directory"}, std::pair{pipe, "this is a pipe"}}) {
    refuses("tact-jitter", "compare " + path + " " + path, words);
    refuses("tact-lab fit", kScene + " --data " + path, words);
    refuses("tact-lab fit", kScene + " --reference " + path, words);
    refuses("tact-lab plan", kScene + " --chart " + path + " --dry-run", words);
    refuses("tact-lab chart", kScene + " --reference " + path + " --out " + folder_ + "/out",
            words);
    refuses("tact-mesh", path, words);
    refuses("tact-lab new-scene", path + " --out " + folder_ + "/new.toml", words);
    refuses("tact-view", "--open " + path, words);
    refuses("tactd", path, words);
    refuses("tactd", kScene + " --replay " + path, words);
  }
  refuses("tact-verify", pipe, "this is a pipe");
}

TEST_F(BadInput, DeeplyNestedFilesAreRefusedByEveryProgram) {
  const std::string scene = folder_ + "/deep.toml", json = folder_ + "/deep.json";
  std::ofstream(scene) << "a = " << std::string(400'000, '[');
  std::ofstream(json) << std::string(400'000, '[');
  refuses("tactd", scene, "deep.toml:1: nested deeper than 64 levels");
  refuses("tactd", kScene + " --set a=" + std::string(1000, '['), "--set a=");
  refuses("tact-jitter", "compare " + json + " " + json, "deep.json:1: nested deeper than 64");
  refuses("tact-verify", json, "deep.json:1: nested deeper than 64");
}

TEST_F(BadInput, OutputOverASceneFileIsRefusedAndTheSceneIsKept) {
  const std::string scene = folder_ + "/scene.toml";
  fs::copy_file(kScene, scene);
  const std::string run = kScene + " --free-run --ticks 10 --no-telemetry --no-black-box ";
  refuses("tactd", run + "--json " + scene, "holds something else");
  refuses("tactd", "--faults --json " + scene, "holds something else");
  refuses("tact-lab condense", kScene + " --out " + scene, "");
  std::ifstream file(scene), before(kScene);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            std::string(std::istreambuf_iterator<char>(before), {}));
}

TEST_F(BadInput, OutputThatGoesNowhereIsStatusTwo) {
  const std::string run = kScene + " --free-run --ticks 10 --no-telemetry --no-black-box ";
  refuses("tactd", run + "--json /dev/full", "No space left");
  refuses("tactd", run + "--json - 2>&1 >/dev/full", "No space left on device");
  refuses("tactd", run + "2>&1 >/dev/full", "No space left on device");
  for (const char* arguments : {"--faults", "--help-scene", "--list-devices"})
    refuses("tactd", std::string(arguments) + " 2>&1 >/dev/full", "No space left on device");
  refuses("tact-doctor", "--json 2>&1 >/dev/full", "No space left on device");
  refuses("tact-limits", "--list 2>&1 >/dev/full", "No space left on device");
  refuses("tact-mesh", TACT_SOURCE_DIR "/model/scenes/meshes/liver_3116.obj 2>&1 >/dev/full",
          "No space left on device");
  refuses("tact-verify", TACT_SOURCE_DIR "/tests/data/vectors --json 2>&1 >/dev/full", "");
}

}  // namespace tact::tools::program::bad_input_test
