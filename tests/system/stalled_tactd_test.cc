// SPDX-License-Identifier: Apache-2.0
// The whole program when its loop hangs: what it says, what it leaves, that it ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace tact::tests::stalled_tactd_test {

// tactd itself. strace holds its loop in its sleep, as a driver would that hangs.
class StalledTactd : public testing::Test {
 protected:
  StalledTactd()
      : folder(testing::TempDir() + "tact-stalled-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  ~StalledTactd() override { std::filesystem::remove_all(folder); }

  std::string run(const std::string& held_us) const {
    const std::string script = folder + "/run.sh";
    std::ofstream(script)
        << tests::program_path("tactd") << " " << kLiver
        << " --no-telemetry --seconds 20 --black-box " << folder << "/kept --json " << folder
        << "/report.json & tactd=$!\n"
        << "until loop=$(grep -ls tact-loop /proc/$tactd/task/*/comm); do sleep .05; done\n"
        << "sleep 1; loop=${loop%/comm}; loop=${loop##*/}\n"
        << "grep Seccomp: /proc/$tactd/task/$loop/status\n"
        << "timeout -s INT 6 strace -qq -o /dev/null -p $loop -e "
           "inject=clock_nanosleep:delay_exit="
        << held_us << ":when=20 >/dev/null 2>&1 &\n"
        << "for i in {1..80}; do compgen -G '" << folder
        << "/kept/*' >/dev/null && break; sleep .1; "
        << "done\nsleep .5; kill -INT $tactd; wait $tactd; echo ended $?\n";
    return tests::run_command("bash " + script).output;
  }
  std::string folder;
  static constexpr const char* kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";
};

TEST_F(StalledTactd, StopsNamesTheFaultAndLeavesAFileThatTactViewShows) {
  const std::string reported = run("400000");
  EXPECT_NE(reported.find("ended 1"), std::string::npos) << reported;
  EXPECT_NE(reported.find("fault 120, loop stalled"), std::string::npos) << reported;
  std::ifstream file(folder + "/report.json");
  const auto report = nlohmann::json::parse(file, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << reported;
  EXPECT_EQ(report.at("fault").at("number"), 120);
  EXPECT_EQ(reported.find("Seccomp:\t2") != std::string::npos,
            report.at("call_filter").get<bool>());
  ASSERT_EQ(report.at("black_boxes").size(), 1u) << reported;
  const std::string kept = report.at("black_boxes")[0];
  const tests::Outcome shown = tests::run_program(
      "tact-view", "--open " + kept + " --export " + folder + "/table.csv --json");
  EXPECT_EQ(shown.status, 0) << shown.output;
  const tests::Outcome table =
      tests::run_program("tactd", "--replay " + kept + " --csv " + folder + "/ticks.csv");
  EXPECT_EQ(table.status, 0) << table.output;
  EXPECT_GT(tests::run_command("grep -c ,stopped, " + folder + "/ticks.csv").output, "0");
  const tests::Outcome replayed =
      tests::run_program("tactd", std::string(kLiver) + " --replay " + kept);
  EXPECT_EQ(replayed.status, 0) << replayed.output;  // it has the run from its first tick on
  EXPECT_NE(replayed.output.find(" ticks computed again, 0 differ"), std::string::npos);
}

TEST_F(StalledTactd, EndsEvenIfItsLoopNeverComesBack) {
  const std::string reported = run("60000000");
  EXPECT_NE(reported.find("ended 1"), std::string::npos) << reported;
  EXPECT_NE(reported.find("fault 120, loop stalled"), std::string::npos) << reported;
  EXPECT_NE(reported.find("the loop does not come back"), std::string::npos) << reported;
  EXPECT_NE(reported.find("black box of fault 120"), std::string::npos) << reported;
}

}  // namespace tact::tests::stalled_tactd_test
