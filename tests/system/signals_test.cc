// SPDX-License-Identifier: Apache-2.0
// No signal of another process to a thread of tactd stops its loop or takes its force, but the two
// that the loop listens to.
#include <sys/syscall.h>

#include <csignal>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::signals_test {

using Signals = Tactd;

std::vector<pid_t> threads_of(pid_t process) {
  std::vector<pid_t> out;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task"))
    out.push_back(std::stoi(task.path().filename()));
  return out;
}

TEST_F(Signals, SignalsToAnyThreadDoNotDisturbTheLoop) {
  const StartedProgram tactd("tactd", {kLiver, "--socket", in_folder("t.sock"), "--set",
                                       "rate_Hz=500", "--black-box", in_folder("kept")});
  const std::string loop = loop_thread(tactd.process(), 200);
  ASSERT_NE(loop, "");
  std::size_t threads = 0;
  for (const pid_t thread : threads_of(tactd.process())) {
    const bool is_main = thread == tactd.process();
    threads += is_main ? 0 : 1;
    for (int signal = 1; signal <= 64; ++signal) {
      if (signal == SIGKILL || signal == SIGSTOP) continue;  // these cannot be refused
      if (signal == SIGXCPU) continue;                       // the runaway guard's
      const bool ends = signal == SIGINT || signal == SIGTERM || signal == SIGHUP ||
                        signal == SIGQUIT || signal == SIGTSTP || signal == SIGABRT;
      if (is_main && ends) continue;  // for the thread that waits for them
      EXPECT_EQ(syscall(SYS_tgkill, tactd.process(), thread, signal), 0) << thread << " " << signal;
    }
  }
  EXPECT_GE(threads, 7u) << "loop, watch, telemetry, box, executor, stop, hand";
  const std::string before =
      field("/proc/" + std::to_string(tactd.process()) + "/task/" + loop + "/status",
            "voluntary_ctxt_switches");
  EXPECT_EQ(loop_thread(tactd.process(), std::stol(before) + 100), loop) << "it ticks on";
  const Outcome status = run_command(program_path("tactctl") + " " + kLiver + " status --pid " +
                                     std::to_string(tactd.process()));
  EXPECT_EQ(status.status, 0) << status.output;
  EXPECT_TRUE(has(status, ": armed, ")) << status.output;
  EXPECT_FALSE(has(status, "fault")) << status.output;
}

}  // namespace tact::tests::signals_test
