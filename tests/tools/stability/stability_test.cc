// SPDX-License-Identifier: Apache-2.0
// Runs tact-lab stability as people do: help, bad options, pictures.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace tact::tools::stability::stability_test {

using tests::Outcome;

Outcome run(const std::string& arguments) {
  return tests::run_program("tact-lab stability", arguments);
}
std::string folder() { return testing::TempDir() + "tact-stability-" + std::to_string(getpid()); }

TEST(Stability, HelpNamesEveryMap) {
  const Outcome out = run("--help");
  EXPECT_EQ(out.status, 0);
  for (const char* word : {"integrators", "law_limits", "law_lines", "loop", "loop_laws",
                           "loop_delta", "ticks", "loss", "Exit status"})
    EXPECT_NE(out.output.find(word), std::string::npos) << word;
}

TEST(Stability, BadOptionsAreOneLineAndStatusTwo) {
  const std::string to = "--out " + folder();
  for (const std::string& bad : {std::string(""), to + " --map e", to + " --only none",
                                 to + " --nonsense", std::string("--out /proc/none --only loss")}) {
    const Outcome out = run(bad);
    EXPECT_EQ(out.status, 2) << bad << "\n" << out.output;
    EXPECT_EQ(out.output.find("tact-lab stability: "), 0u) << out.output;
    EXPECT_EQ(std::count(out.output.begin(), out.output.end(), '\n'), 1) << out.output;
  }
  std::filesystem::remove_all(folder());
}

TEST(Stability, MakesTableFindingsAndPictures) {
  const Outcome out = run("--out " + folder() + " --quick --only loss --json");
  EXPECT_EQ(out.status, 0) << out.output;
  const auto report = nlohmann::json::parse(out.output).at("maps").at(0);
  EXPECT_EQ(report.at("map"), "loss");
  for (const auto& finding : report.at("findings")) EXPECT_TRUE(finding.at("holds").get<bool>());
  for (const char* end : {".csv", ".json", ".svg", ".png", ".gp"})
    EXPECT_TRUE(std::filesystem::exists(folder() + "/loss" + end)) << end;
  std::filesystem::remove_all(folder());
}

}  // namespace tact::tools::stability::stability_test
