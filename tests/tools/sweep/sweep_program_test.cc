// SPDX-License-Identifier: Apache-2.0
// tact-lab sweep as a person meets it: a coarse scene, one vertex, bad input, Ctrl-C.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace tact::tools::sweep::sweep_program_test {

namespace fs = std::filesystem;
using tests::Outcome;

const std::string kPlain = TACT_SOURCE_DIR "/tests/data/scenes/plain.toml";
const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

class Sweep : public ::testing::Test {
 protected:
  ~Sweep() override { fs::remove_all(folder_); }
  Outcome run(const std::string& arguments) const {
    return tests::run_program("tact-lab sweep", arguments + " --out " + folder_);
  }
  std::string lines_of(const std::string& name) const {
    std::ifstream file(folder_ + "/" + name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::string folder_ = testing::TempDir() + "tact-sweep-" + std::to_string(getpid());
};

bool has(const Outcome& out, const std::string& part) {
  return out.output.find(part) != std::string::npos;
}

TEST_F(Sweep, HelpSaysUnitsAnExampleAndWhatIsChecked) {
  const Outcome out = tests::run_program("tact-lab sweep", "--help");
  EXPECT_EQ(out.status, 0);
  for (const char* word : {"--vertices", "--vertex", "--step-m", "--depth-m", "--square",
                           "--upright", "Example:", "N/m", "within 2 %", "Exit status"})
    EXPECT_TRUE(has(out, word)) << word;
}

TEST_F(Sweep, TheShippedLiverIsHeldAgainstSolvedPresses) {
  const std::string truth = TACT_SOURCE_DIR "/tests/data/reference/liver_finite_strain.json";
  const Outcome out = tests::run_program("tact-lab sweep", kLiver + " --json --reference " + truth);
  ASSERT_EQ(out.status, 0) << out.output;
  const auto reported = nlohmann::json::parse(out.output);
  ASSERT_EQ(reported.size(), 3U);
  for (const auto& [place, press] : reported.items()) {
    EXPECT_LT(std::abs(press.at("worst_ratio").get<double>()), 0.07) << place;
    EXPECT_GT(std::abs(press.at("worst_ratio").get<double>()), 1e-4) << place;
    EXPECT_LT(press.at("worst_sphere_ratio").get<double>(), 0.10) << place;
    EXPECT_EQ(press.at("off_ratio").size(), 6U) << place;
  }
  EXPECT_TRUE(
      has(tests::run_program("tact-lab sweep", kLiver + " --reference " + truth), "hand's"));
}

TEST_F(Sweep, AFileOfNoPressesIsRefused) {
  const Outcome out = tests::run_program("tact-lab sweep", kLiver + " --reference " + kLiver);
  EXPECT_EQ(out.status, 2);
  EXPECT_TRUE(has(out, "not JSON")) << out.output;
  const Outcome none = tests::run_program("tact-lab sweep", kLiver);
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(has(none, "--out FOLDER")) << none.output;
}

TEST_F(Sweep, CoarseSceneIsPressedWithTableAndPicture) {
  const Outcome out = run(kPlain + " --vertices all --depth-m 0.002 --square --json");
  ASSERT_EQ(out.status, 0) << out.output;
  const auto reported = nlohmann::json::parse(out.output);
  EXPECT_EQ(reported.at("format"), "tact-sweep");
  EXPECT_GT(reported.at("pressed").get<int>(), 0);
  EXPECT_GT(reported.at("stiffest").at("slope_N_per_m").get<double>(), 0.0);
  EXPECT_TRUE(reported.at("flawed").empty());
  for (const char* end : {".csv", ".json", ".svg", ".png", ".gp"})
    EXPECT_TRUE(fs::exists(folder_ + "/presses" + end)) << end;
  const std::string table = lines_of("presses.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + reported.at("pressed").get<int>() +
                                                              reported.at("missed").get<int>() +
                                                              reported.at("blocked").get<int>());
}

// Of one press the whole way is written; a limit that no tissue keeps makes it fail.
TEST_F(Sweep, FailedCheckIsStatusOneNamedWithTheCommandThatRepeatsIt) {
  const std::string one = kPlain + " --vertex 0 --square --depth-m 0.002";
  const Outcome good = run(one);
  EXPECT_EQ(good.status, 0) << good.output;
  EXPECT_TRUE(lines_of("press.csv").starts_with("depth_m,force_N,")) << lines_of("press.csv");
  const Outcome bad = run(one + " --limit-N-per-m 1");
  EXPECT_EQ(bad.status, 1) << bad.output;
  EXPECT_TRUE(has(bad, "vertex 0, square: the force changes by ")) << bad.output;
  EXPECT_TRUE(has(bad, "the slope is ")) << bad.output;
  const std::string again = "tact-lab sweep " + kPlain + " --out " + folder_ +
                            " --depth-m 0.002 --limit-N-per-m 1 --vertex 0 --square\n";
  EXPECT_TRUE(has(bad, again)) << bad.output;
}

TEST_F(Sweep, BadInputIsOneLineAndStatusTwo) {
  for (const auto& [arguments, words] :
       {std::pair{kLiver + " --vertices 0", "is no number above 0 and not all"},
        std::pair{kLiver + " --vertices x", "is no number above 0 and not all"},
        std::pair{kLiver + " --vertex 99999", "the organ has the vertices 0 to 3115"},
        std::pair{kLiver + " --step-m 0", "--step-m"},
        std::pair{kLiver + " --depth-m -1", "--depth-m"},
        std::pair{kLiver + " --set rate_Hz=-1", "rate_Hz"},
        std::pair{std::string("none.toml"), "none.toml"}}) {
    const Outcome out = run(arguments);
    EXPECT_EQ(out.status, 2) << arguments << "\n" << out.output;
    EXPECT_TRUE(has(out, words)) << out.output;
    EXPECT_EQ(out.output.find("tact-lab sweep: "), 0U) << out.output;
    EXPECT_EQ(std::count(out.output.begin(), out.output.end(), '\n'), 1) << out.output;
  }
  EXPECT_EQ(tests::run_program("tact-lab sweep", kLiver).status, 2) << "without --out";
  EXPECT_EQ(tests::run_program("tact-lab sweep", kPlain + " --out /proc/none").status, 2);
}

TEST_F(Sweep, ThreadsChangeNoNumber) {
  const std::string some = kPlain + " --vertices 40 --depth-m 0.002 --no-pictures";
  run(some);
  const std::string first = lines_of("presses.csv");
  run(some);
  EXPECT_EQ(first, lines_of("presses.csv"));
  EXPECT_FALSE(first.empty());
}

TEST_F(Sweep, CtrlCEndsItWithinASecondAndWritesNothing) {
  const auto begun = std::chrono::steady_clock::now();
  const Outcome out = tests::run_command("timeout --foreground -s INT 0.7 " +
                                         tests::program_path("tact-lab sweep") + " " + kLiver +
                                         " --vertices all --step-m 1e-6 --out " + folder_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  EXPECT_TRUE(has(out, "tact-lab sweep: interrupted; nothing was written")) << out.output;
  EXPECT_LT(took.count(), 0.7 + 20.0);  // no time is asserted closely (tests/README.md)
  EXPECT_FALSE(fs::exists(folder_ + "/presses.csv"));
}

}  // namespace tact::tools::sweep::sweep_program_test
