// tact-reference as a person meets it: what it says when something is missing or wrong.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/program.h"

namespace tact::tests {
namespace {

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

void expect_refusal(const std::string& arguments, const std::string& sentence) {
  const Outcome outcome = run_program("tact-reference", arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_EQ(outcome.output, "tact-reference: " + sentence + "\n");
}

TEST(ReferenceProgram, TellsItsOptionsWithUnits) {
  const Outcome outcome = run_program("tact-reference", "--help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"--depths", "m, above 0", "--self-check", "apt install gmsh calculix"})
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
}

TEST(ReferenceProgram, RefusesWhatCannotBeSolved) {
  expect_refusal("", "no scene given; see tact-reference --help");
  expect_refusal(kLiver + " --sites 99999",
                 "site 99999 is no vertex of liver_3116.obj; they are 0 to 3115");
  for (const char* depths : {"0.002,0.001", "0.001,nan", "1.5"})
    expect_refusal(kLiver + " --sites 1714 --depths " + depths,
                   "--depths must rise, all above 0 and at most 0.02 m (5 tool radii); give "
                   "metres: 0.001,0.002");
  expect_refusal(kLiver + " --sites 125", "site 125 lies in the box that is held; choose another");
  expect_refusal("--self-check /nowhere",
                 "/nowhere/organ_patch.json: cannot be read; give the "
                 "folder tests/data/reference");
}

TEST(ReferenceProgram, SaysWhatToInstallAndLeavesNoFile) {
  const auto out = std::filesystem::path(testing::TempDir()) / "reference_program_test.json";
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  expect_refusal(kLiver + " --sites 1714 --out " + out.string(),
                 "gmsh is not installed; apt install gmsh");
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace tact::tests
