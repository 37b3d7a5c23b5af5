// SPDX-License-Identifier: Apache-2.0
// The loop's thread of a running tactd, as the kernel sees it.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <vector>

#include "firmware/loop/alloc_counter.h"
#include "firmware/pc/rt_needs.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::thread_costs_test {

using nlohmann::json;
using LoopThread = Tactd;

/// What the kernel refuses to a process of this user, which tactd asks for; empty: nothing.
std::string refused_rights() {
  std::string refused;
  std::thread([&] {
    const sched_param loop{.sched_priority = tact::firmware::pc::kLoopPriority};
    if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &loop) != 0)
      refused = "no right to real-time priority " + std::to_string(loop.sched_priority);
  }).join();
  rlimit locked{};
  getrlimit(RLIMIT_MEMLOCK, &locked);
  if (geteuid() != 0 && locked.rlim_cur != RLIM_INFINITY) refused = "no right to lock its memory";
  return refused;
}

TEST_F(LoopThread, NeverAllocatesAndNeverFaultsAPage) {
  // A kernel that compacts memory may move even a locked page, once in a long while: a fault of
  // ours would be there in every run.
  const bool counts = tact::firmware::loop::can_count_heap_calls();
  long fewest_minor = 1000;
  for (int run = 0; run < 3 && fewest_minor > 0; ++run) {
    const json thread = report_of(kLiver + " --seconds 3").at("thread");
    if (counts) EXPECT_EQ(thread.at("allocations"), 0);
    EXPECT_EQ(thread.at("major_page_faults"), 0);
    fewest_minor = std::min(fewest_minor, thread.at("minor_page_faults").get<long>());
  }
  if (!tact::firmware::loop::is_sanitized()) EXPECT_EQ(fewest_minor, 0);
}

TEST_F(LoopThread, HasPriority80OneCoreAndLockedMemory) {
  const std::string refused = refused_rights();
  if (!refused.empty()) GTEST_SKIP() << refused;
  StartedProgram tactd("tactd", {kLiver, "--socket", in_folder("t.sock")});
  const std::string loop = loop_thread(tactd.process(), 20);
  ASSERT_NE(loop, "");
  const std::string task = "/proc/" + std::to_string(tactd.process()) + "/task/" + loop;
  std::ifstream stat(task + "/stat");
  std::string text;
  std::getline(stat, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));  // from field 3 on
  const std::vector<std::string> value{std::istream_iterator<std::string>(fields), {}};
  EXPECT_EQ(value.at(40 - 3), "80") << "real-time priority";
  EXPECT_EQ(value.at(41 - 3), "1") << "SCHED_FIFO";
  EXPECT_EQ(field(task + "/status", "Cpus_allowed_list").find_first_of(",-"), std::string::npos)
      << "one core";
  if (tact::firmware::loop::is_sanitized()) return;  // sanitizers do not let memory be locked
  EXPECT_GT(std::stol(field(task + "/status", "VmLck")), 4000) << "kB locked";
}

TEST_F(LoopThread, MakesNoSystemCallButSleep) {
  StartedProgram tactd("tactd", {kLiver, "--socket", in_folder("t.sock")});
  const std::string loop = loop_thread(tactd.process(), 200);
  ASSERT_NE(loop, "");
  const std::string trace = in_folder("trace");
  const Outcome traced =
      run_command("strace -qq -o " + trace + " -p " + loop +
                  " & strace=$!; for i in $(seq 600); do "
                  "[ $(wc -l < " +
                  trace + ") -gt 2000 ] && break; sleep .1; done; kill -INT $strace; wait");
  int sleeps = 0;
  std::ifstream file(trace);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("clock_nanosleep(", 0) == 0 || line.rfind("restart_syscall(", 0) == 0 ||
        line.find("resumed>") != std::string::npos) {
      ++sleeps;
      continue;
    }
    ADD_FAILURE() << "system call in the loop: " << line;
  }
  EXPECT_GT(sleeps, 2000) << "the trace saw the loop: " << traced.output;
}

}  // namespace tact::tests::thread_costs_test
