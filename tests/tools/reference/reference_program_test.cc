// SPDX-License-Identifier: Apache-2.0
// tact-lab reference as a person meets it: what it says when something is missing or wrong.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/needs_calculix.h"
#include "tests/support/program.h"

namespace tact::tests::reference_program_test {

namespace fs = std::filesystem;
const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

void expect_refusal(const std::string& arguments, const std::string& message) {
  const Outcome outcome = run_program("tact-lab reference", arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_EQ(outcome.output, "tact-lab reference: " + message + "\n");
}

TEST(ReferenceProgram, TellsItsOptionsWithUnits) {
  const Outcome outcome = run_program("tact-lab reference", "--help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"--depths", "m, above 0", "--self-check", "apt install gmsh calculix"})
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
}

TEST(ReferenceProgram, RefusesWhatCannotBeSolved) {
  expect_refusal("", "no scene given; see tact-lab reference --help");
  expect_refusal(kLiver + " --sites 99999",
                 "site 99999 is no vertex of liver_3116.obj; they are 0 to 3115");
  for (const char* depths : {"0.002,0.001", "0.001,0.001", "1.5"})
    expect_refusal(kLiver + " --sites 1714 --depths " + depths,
                   "--depths must rise, all above 0 and at most 0.02 m (5 tool radii); give "
                   "metres: 0.001,0.002");
  expect_refusal(kLiver + " --sites 125",
                 "site 125 lies in the held box, elastic.fixed_min_m to elastic.fixed_max_m; "
                 "choose another, or move the box");
  expect_refusal("--self-check /nowhere",
                 "/nowhere/organ_patch.json: no such file; give the "
                 "folder tests/data/reference");
}

using ReferenceProgramSolves = NeedsCalculiX;

TEST_F(ReferenceProgramSolves, NoOrganThatNothingHolds) {
  expect_refusal(kLiver +
                     " --sites 1714 --set elastic.fixed_min_m=[5,5,5] --set "
                     "elastic.fixed_max_m=[6,6,6]",
                 "no triangle of the organ lies in the held box, so it would fly away; move "
                 "elastic.fixed_min_m and elastic.fixed_max_m (tact-mesh --align proposes them)");
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

/// A program in this folder that does as the shell script says.
void make_program(const fs::path& path, const std::string& script) {
  std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
  fs::permissions(path, fs::perms::owner_all);
}

TEST(ReferenceProgram, JobsOfOneSiteShareItsCoarseSolve) {
  const auto folder =
      fs::path(testing::TempDir()) / fmt::format("reference_program_test.{}", getpid());
  fs::create_directories(folder);
  make_program(folder / "gmsh",
               "[ \"$1\" = --version ] && echo 4.8.4 && exit\n"
               "echo once >> " +
                   (folder / "calls").string() + "; sleep 0.5; exit 3");
  make_program(folder / "ccx", "echo This is Version 2.20");
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  setenv("TMPDIR", folder.c_str(), 1);  // for what a failure keeps
  const Outcome outcome =
      run_program("tact-lab reference",
                  kLiver + " --sites 1714 --jobs 4 --cache " + (folder / "cache").string());
  setenv("PATH", path.c_str(), 1);
  unsetenv("TMPDIR");
  EXPECT_NE(outcome.output.find("gmsh ended with status 3"), std::string::npos) << outcome.output;
  std::ifstream calls(folder / "calls");
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(calls), {}, '\n'), 1) << "solves at once";
  fs::remove_all(folder);
}

// Solves every linear case by 1 mN a moved node, and no other.
const char* const kLinearOnly = R"([ "$1" = -v ] && echo This is Version 2.20 && exit
if grep -q NLGEOM case.inp; then
  grep -q CONTACT case.inp && echo ball >> "$TMPDIR/loads" || echo bond >> "$TMPDIR/loads"
  echo no convergence; exit 201
fi
awk -F, '/^[*]/ { set = "" } /^[*]NSET/ { set = $2; next }
  set == "NSET=MOVED" { for (i = 1; i <= NF; ++i) if ($i) moved = moved $i " 1 0 0\n" }
  set == "NSET=REPORTED" { for (i = 1; i <= NF; ++i) if ($i) reported = reported $i " 0 0 0\n" }
  END {
    print "forces (fx,fy,fz) for set MOVED and time 1\n\n" moved
    print "displacements (vx,vy,vz) for set REPORTED and time 1\n\n" reported
  }' case.inp > case.dat)";

TEST(ReferenceProgram, TellsWhichLargeStrainHasNoSolutionAndKeepsTheRest) {
  const auto folder =
      fs::path(testing::TempDir()) / fmt::format("reference_program_test.large.{}", getpid());
  fs::create_directories(folder);
  make_program(folder / "ccx", kLinearOnly);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  setenv("TMPDIR", folder.c_str(), 1);  // for what a failure keeps
  const Outcome outcome =
      run_program("tact-lab reference", kLiver +
                                            " --sites 1714 --depths 0.002,0.007 --level 1 "
                                            "--large-strain 1714 --cache " +
                                            (folder / "cache").string());
  setenv("PATH", path.c_str(), 1);
  unsetenv("TMPDIR");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  for (const char* what : {"press of 2 mm", "press of 7 mm", "pull of 2 mm"})
    EXPECT_NE(outcome.output.find(
                  fmt::format("tact-lab reference: left out: vertex 1714, {} with large strain: "
                              "CalculiX found no solution: ccx ended with status 201",
                              what)),
              std::string::npos)
        << outcome.output;
  EXPECT_EQ(outcome.output.find("pull of 7 mm"), std::string::npos) << "beyond 1.3 radii of 4 mm";
  EXPECT_NE(outcome.output.find("left out: pulls with large strain beyond 5.2 mm"),
            std::string::npos);
  EXPECT_EQ(outcome.output.find("neo-Hookean"), std::string::npos);
  std::size_t rows = 0;
  for (auto at = outcome.output.find("  linear\n"); at != std::string::npos;
       at = outcome.output.find("  linear\n", at + 1))
    ++rows;
  EXPECT_EQ(rows, 4U) << "press and pull, 2 and 7 mm";
  std::ifstream file(folder / "loads");
  const std::vector<std::string> loads{std::istream_iterator<std::string>(file), {}};
  EXPECT_EQ(std::count(loads.begin(), loads.end(), "ball"), 4) << "2 and 7 mm at two levels";
  EXPECT_EQ(std::count(loads.begin(), loads.end(), "bond"), 2) << "2 mm at two levels";
  fs::remove_all(folder);
}

TEST(ReferenceProgram, TriesItsFileBeforeTheWork) {
  expect_refusal(kLiver + " --sites 1714 --out /nowhere/liver.json",
                 "/nowhere/liver.json: cannot be written: No such file or directory; check the "
                 "folder, who may write there and the free space");
}

}  // namespace tact::tests::reference_program_test
