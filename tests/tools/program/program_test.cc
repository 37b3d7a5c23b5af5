// SPDX-License-Identifier: Apache-2.0
#include "tools/program/program.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>

#include "tools/program/run_program.h"

namespace tact::tools::program::program_test {

namespace fs = std::filesystem;

std::optional<int> parse(Program& program, std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  return program.parse(static_cast<int>(argv.size()), argv.data());
}

TEST(Program, EndsWithStatusTwoAndOneLineAtABadOption) {
  Program program("tact-test", "A test.", "No units.");
  testing::internal::CaptureStderr();
  EXPECT_EQ(parse(program, {"tact-test", "--nonsense"}), 2);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said.find("tact-test: "), 0U) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST(Program, RemembersItsCommandAndGoesOn) {
  Program program("tact-test", "A test.", "No units.");
  SceneArguments scene;
  scene.add_to(program.options(), "[tolerance]");
  EXPECT_EQ(parse(program, {"tact-test", "a.toml", "--set", "x=1", "--set", "y=2"}), std::nullopt);
  EXPECT_EQ(program.command(), "tact-test a.toml --set x=1 --set y=2");
  EXPECT_EQ(scene.path, "a.toml");
  EXPECT_EQ(scene.overrides, (std::vector<std::string>{"x=1", "y=2"}));
}

TEST(Program, TellsCtrlCFromAFault) {
  const Program program("tact-test", "A test.", "No units.");
  testing::internal::CaptureStderr();
  EXPECT_EQ(program.fail({"a.toml: is missing; correct the name"}), 2);
  EXPECT_EQ(program.fail(interruption(), "two maps are written"), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "tact-test: a.toml: is missing; correct the name\n"
            "tact-test: interrupted; two maps are written\n");
}

TEST(Program, TakesAShardOrAMergeButNotBoth) {
  for (const auto& [words, status] :
       {std::pair{std::vector<std::string>{"t", "--shard", "1/4"}, std::optional<int>{}},
        {{"t", "--merge", "a.csv", "b.csv"}, std::optional<int>{}},
        {{"t", "--shard", "1/4", "--merge", "a.csv"}, std::optional<int>{2}}}) {
    Program program("tact-test", "A test.", "No units.");
    SweepArguments sweep;
    sweep.add_to(program.options(), "row", "fewer");
    testing::internal::CaptureStderr();
    EXPECT_EQ(parse(program, words), status);
    testing::internal::GetCapturedStderr();
    if (words[1] == "--shard" && !status) {
      EXPECT_FALSE(sweep.prepare(testing::TempDir()));
      EXPECT_EQ(sweep.shard.index, 1U);
      EXPECT_EQ(sweep.shard.count, 4U);
    }
  }
}

TEST(Output, IsTriedBeforeTheWork) {
  EXPECT_TRUE(prepare_folder("/proc/none"));
  const std::string folder = testing::TempDir() + "tact-program-test/below";
  EXPECT_FALSE(prepare_folder(folder));
  EXPECT_TRUE(fs::is_directory(folder));
  EXPECT_TRUE(check_output("/nowhere/at/all.toml", "#", {}));
  EXPECT_FALSE(check_output(folder + "/new.toml", "#", {}));
  EXPECT_TRUE(check_output(folder, "#", {})) << "a folder";
  EXPECT_FALSE(check_output("", "#", {}));
  fs::remove_all(testing::TempDir() + "tact-program-test");
}

TEST(Output, NeverReplacesAnInput) {
  const std::string file = testing::TempDir() + "tact-program-test.csv";
  std::ofstream(file) << "depth_m,force_N\n";
  const auto error = check_output(file, "depth_m,u", {"", file});
  ASSERT_TRUE(error);
  EXPECT_NE(error->sentence.find("name another"), std::string::npos);
  EXPECT_FALSE(check_output(file, "depth_m,u", {}));
  EXPECT_TRUE(check_output(file, "{", {})) << "another kind of file";
  fs::remove(file);
}

}  // namespace tact::tools::program::program_test
