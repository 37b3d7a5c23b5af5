// SPDX-License-Identifier: Apache-2.0
#include "tools/program/run_program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tools/program/interrupt.h"

namespace tact::tools::program::run_program_test {

namespace fs = std::filesystem;
using model::Result;

ScratchFolder folder() {
  auto made = ScratchFolder::make("tact-run-program-test");
  EXPECT_TRUE(made) << made.error().message;
  return std::move(*made);
}

Result<std::string> run(const ScratchFolder& where, const std::string& program,
                        std::vector<std::string> arguments, double time_limit_s = 10.0) {
  return run_program({.program = program,
                      .arguments = std::move(arguments),
                      .directory = where.path(),
                      .log_path = where.file("log"),
                      .package = "the-package",
                      .time_limit_s = time_limit_s});
}

/// Gone, or a zombie that was not reaped yet. A killed process needs a moment to die.
bool goes_away(pid_t process) {
  using namespace std::chrono_literals;
  const std::string state = "/proc/" + std::to_string(process) + "/stat";
  for (const auto end = std::chrono::steady_clock::now() + 5s;
       std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(5ms)) {
    std::string number, name, letter = "Z";
    std::ifstream(state) >> number >> name >> letter;
    if (letter == "Z") return true;
  }
  return false;
}

TEST(RunProgram, KeepsWhatWasPrintedAndTakesArgumentsAsTheyAre) {
  const auto where = folder();
  const auto said = run(where, "printf", {"%s|", "a b", "$HOME", "'\"*"});
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_EQ(*said, "a b|$HOME|'\"*|");
}

TEST(RunProgram, HandsOnEachLineAsItComes) {
  const auto where = folder();
  std::vector<std::string> lines;
  bool came_before_the_end = false;
  const auto said = run_program({.program = "sh",
                                 .arguments = {"-c", "echo one; sleep 0.3; echo two; printf thr"},
                                 .directory = where.path(),
                                 .log_path = where.file("log"),
                                 .package = "the-package",
                                 .on_line = [&](std::string_view line) {
                                   lines.emplace_back(line);
                                   came_before_the_end |=
                                       lines.size() == 1 && fs::file_size(where.file("log")) == 4;
                                 }});
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two"}));
  EXPECT_TRUE(came_before_the_end);
}

TEST(RunProgram, RunsInItsFolderWithOurEnvironment) {
  const auto where = folder();
  setenv("TACT_TEST", "a value", 1);
  const auto said = run(where, "sh", {"-c", "pwd; echo $TACT_TEST; echo to stderr >&2"});
  unsetenv("TACT_TEST");
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_EQ(*said, fs::canonical(where.path()).string() + "\na value\nto stderr\n");
}

TEST(RunProgram, SaysWhatToInstall) {
  const auto where = folder();
  const auto said = run(where, "no-such-program-of-tact", {});
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().message,
            "no-such-program-of-tact is not installed; apt install the-package");
}

TEST(RunProgram, ReportsTheLastLinesOfAFailure) {
  const auto where = folder();
  const auto said = run(where, "sh", {"-c", "seq 100; echo the cause; exit 3"});
  ASSERT_FALSE(said);
  const std::string& message = said.error().message;
  EXPECT_NE(message.find("status 3"), std::string::npos) << message;
  EXPECT_NE(message.find("the cause"), std::string::npos) << message;
  EXPECT_NE(message.find(where.file("log")), std::string::npos) << message;
  EXPECT_EQ(message.find("\n50\n"), std::string::npos) << "only the end belongs in a message";
  EXPECT_EQ(said.error().code, model::ErrorCode::kOther);
}

TEST(RunProgram, ACrashHasItsOwnCode) {
  const auto said = run(folder(), "sh", {"-c", "kill -SEGV $$"});
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().code, model::ErrorCode::kProgramCrashed);
}

TEST(RunProgram, EndsAProgramAndItsChildrenAfterTheTimeLimit) {
  const auto where = folder();
  const auto said = run(where, "sh", {"-c", "sleep 60 & echo $!; wait"}, 1.0);
  ASSERT_FALSE(said);
  EXPECT_NE(said.error().message.find("took longer than 1 s"), std::string::npos)
      << said.error().message;
  pid_t child = 0;
  std::ifstream(where.file("log")) >> child;
  ASSERT_GT(child, 1);
  EXPECT_TRUE(goes_away(child)) << "process " << child << " goes on";
}

TEST(RunProgram, EndsAProgramAtCtrlC) {
  const auto where = folder();
  const InterruptFlag watch;
  std::jthread ctrl_c([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::raise(SIGINT);
  });
  const auto said = run(where, "sleep", {"60"});
  ASSERT_FALSE(said);
  EXPECT_TRUE(was_interrupted(said.error())) << said.error().message;
}

pid_t written_number(const std::string& path) {
  using namespace std::chrono_literals;
  pid_t number = 0;
  for (int i = 0; i < 1000 && number == 0; ++i, std::this_thread::sleep_for(5ms))
    std::ifstream(path) >> number;
  return number;
}

TEST(RunProgram, EndsAProgramAtAClosedTerminalAndAtTermination) {
  for (const int signal : {SIGHUP, SIGTERM}) {
    const auto where = folder();
    const InterruptFlag watch;
    std::jthread sender([signal] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      std::raise(signal);
      if (signal == SIGHUP) std::raise(signal);  // some terminals send it twice
    });
    const auto said = run(where, "sleep", {"60"});
    ASSERT_FALSE(said);
    EXPECT_TRUE(was_interrupted(said.error())) << said.error().message;
  }
}

TEST(InterruptFlag, LetsNohupBeAndForgetsWhatItEndsWith) {
  std::signal(SIGHUP, SIG_IGN);
  {
    const InterruptFlag watch;
    std::raise(SIGHUP);
    EXPECT_FALSE(is_interrupted());
    std::raise(SIGINT);
    EXPECT_TRUE(is_interrupted());
  }
  EXPECT_FALSE(is_interrupted());
  EXPECT_EQ(std::signal(SIGHUP, SIG_DFL), SIG_IGN);
}

TEST(RunProgram, AsksAProgramToEndSoThatItCanEndWhatItHasStarted) {
  const auto where = folder();
  const std::string file = where.file("its");
  const InterruptFlag watch;
  const std::jthread hand([&] {
    written_number(where.file("log"));
    std::raise(SIGINT);
  });
  // A group of its own, as run_program gives each program; set -m does it in a shell.
  const auto said = run(where, "bash",
                        {"-c", "set -m; touch " + file + "; sleep 60 & trap 'kill %1; rm " + file +
                                   "; exit' TERM; echo $!; wait"},
                        20.0);
  ASSERT_FALSE(said);
  EXPECT_FALSE(std::filesystem::exists(file));
  const pid_t child = written_number(where.file("log"));
  ASSERT_GT(child, 1);
  EXPECT_TRUE(goes_away(child)) << "process " << child << " goes on";
}

TEST(RunProgram, ASecondCtrlCLeavesNoProgramAndNoFolder) {
  const auto where = folder();
  const pid_t ours = fork();
  if (ours == 0) {  // a program of ours, that a person ends with two quick presses
    const InterruptFlag watch;
    const auto scratch = ScratchFolder::make("tact-run-program-test");
    std::ofstream(where.file("scratch")) << scratch->path() << '\n';
    std::ofstream(scratch->file("log")) << "not empty\n";
    const std::jthread hand([&, main = pthread_self()] {  // workers take no signal
      if (written_number(where.file("log")) == 0) _exit(1);
      pthread_kill(main, SIGINT);
      while (!is_interrupted()) std::this_thread::yield();
      pthread_kill(main, SIGINT);
    });
    // Deaf to the first press, so that the second comes before its end.
    (void)run(where, "sh", {"-c", "trap '' TERM; sleep 60 & echo $!; wait"}, 20.0);
    _exit(0);
  }
  int status = 0;
  waitpid(ours, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  std::string scratch;
  std::getline(std::ifstream(where.file("scratch")), scratch);
  ASSERT_FALSE(scratch.empty());
  EXPECT_FALSE(fs::exists(scratch)) << scratch;
  const pid_t grandchild = written_number(where.file("log"));
  ASSERT_GT(grandchild, 1);
  EXPECT_TRUE(goes_away(grandchild)) << "process " << grandchild << " goes on";
}

TEST(RunProgram, EndsWhatItsLeaderLeavesBehind) {
  const auto where = folder();
  const auto said = run(where, "sh", {"-c", "sleep 60 & echo $!"});
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_TRUE(goes_away(std::stoi(*said)));
}

TEST(RunningProgram, GoesWithItsWholeGroupWhenItsObjectGoes) {
  const auto where = folder();
  pid_t grandchild = 0;
  {
    const auto running = RunningProgram::start({.program = "sh",
                                                .arguments = {"-c", "sleep 60 & echo $!; wait"},
                                                .directory = where.path(),
                                                .log_path = where.file("log"),
                                                .package = {}});
    ASSERT_TRUE(running) << running.error().message;
    grandchild = written_number(where.file("log"));
    ASSERT_GT(grandchild, 1);
    EXPECT_TRUE(running->is_running());
  }
  EXPECT_TRUE(goes_away(grandchild)) << "process " << grandchild << " goes on";
}

TEST(RunningProgram, IsKnownToHaveEnded) {
  const auto where = folder();
  const auto running = RunningProgram::start({.program = "true",
                                              .arguments = {},
                                              .directory = where.path(),
                                              .log_path = where.file("log"),
                                              .package = {}});
  ASSERT_TRUE(running) << running.error().message;
  for (int i = 0; i < 500 && running->is_running(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(running->is_running());
}

TEST(RunProgram, AnUnknownEndIsAnError) {
  const auto where = folder();
  std::signal(SIGCHLD, SIG_IGN);  // a parent may hand this down
  const auto said = run(where, "false", {});
  std::signal(SIGCHLD, SIG_DFL);
  ASSERT_FALSE(said);
  EXPECT_NE(said.error().message.find("SIGCHLD is ignored"), std::string::npos)
      << said.error().message;
}

TEST(RunProgram, AProgramTakesTheSignalsThatWeTake) {
  const auto where = folder();
  const auto said = run(where, "grep", {"SigBlk", "/proc/self/status"});
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_EQ(*said, "SigBlk:\t0000000000000000\n");
}

TEST(ScratchFolder, IsNewAndGoneAfterwards) {
  std::string first;
  {
    const auto a = folder(), b = folder();
    first = a.path();
    EXPECT_NE(first, b.path());
    EXPECT_TRUE(fs::is_directory(first));
  }
  EXPECT_FALSE(fs::exists(first));
}

}  // namespace tact::tools::program::run_program_test
