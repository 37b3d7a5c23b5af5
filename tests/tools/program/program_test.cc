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

TEST(Program, DistinguishesCtrlCFromAFault) {
  const Program program("tact-test", "A test.", "No units.");
  testing::internal::CaptureStderr();
  EXPECT_EQ(program.fail({"a.toml: is missing; correct the name"}), 2);
  EXPECT_EQ(program.fail(interruption(), "two maps are written"), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "tact-test: a.toml: is missing; correct the name\n"
            "tact-test: interrupted; two maps are written\n");
}

struct Word {
  std::string word;
};

/// What `tact-lab WORDS` says on standard error; its exit status comes first.
std::string said_by_lab(std::vector<std::string> words) {
  Program lab("tact-lab", "A test.", "No units.");
  for (const char* name : {"report", "other"})
    lab.add<Word>(
        name, "reports a word", "No units.",
        [](CLI::App& app, Word& w) { app.add_option("--word", w.word, "")->required(); },
        [](const Program& program, Word& w) -> model::Result<int> {
          if (w.word == "bad") return model::Error{"bad: give another"};
          return program.command() == "tact-lab report --word good" ? 1 : 0;
        });
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  testing::internal::CaptureStderr();
  const int status = lab.run(static_cast<int>(argv.size()), argv.data());
  return std::to_string(status) + " " + testing::internal::GetCapturedStderr();
}

TEST(Program, RunsTheSubcommandThatIsNamed) {
  EXPECT_EQ(said_by_lab({"tact-lab", "report", "--word", "good"}), "1 ");
  EXPECT_EQ(said_by_lab({"tact-lab", "other", "--word", "report"}), "0 ") << "a word as a value";
  EXPECT_EQ(said_by_lab({"tact-lab", "report", "--word", "bad"}),
            "2 tact-lab report: bad: give another\n");
  EXPECT_EQ(said_by_lab({"tact-lab", "report"}),
            "2 tact-lab report: --word is required; see tact-lab report --help\n");
  EXPECT_EQ(said_by_lab({"tact-lab", "report", "--wird", "x"}).find("2 tact-lab report: "), 0U);
  for (const char* none : {"--word", "tall"}) {
    const std::string said = said_by_lab({"tact-lab", none});
    EXPECT_EQ(said.find("2 tact-lab: "), 0U) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
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
  EXPECT_NE(error->message.find("name another"), std::string::npos);
  EXPECT_FALSE(check_output(file, "depth_m,u", {}));
  EXPECT_TRUE(check_output(file, "{", {})) << "another kind of file";
  fs::remove(file);
}

}  // namespace tact::tools::program::program_test
