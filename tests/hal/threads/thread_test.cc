// SPDX-License-Identifier: Apache-2.0
// What a thread takes of signals, and what becomes of one that does not start or throws.
#include "hal/threads/thread.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>

namespace tact::hal::threads::thread_test {

std::string field(const char* name) {
  std::ifstream status("/proc/thread-self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name)) return line.substr(line.find('\t') + 1);
  return "";
}

TEST(Thread, BlocksEverySignalButTwoAndThoseOfACrash) {
  std::string blocked, name;
  auto thread = start_thread("a-name", [&] {
    blocked = field("SigBlk:");
    name = field("Name:");
  });
  ASSERT_TRUE(thread);
  thread->join();
  EXPECT_EQ(name, "a-name");
  std::uint64_t taken = 0;
  // No thread can block the last two.
  for (const int signal :
       {SIGSYS, SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGKILL, SIGSTOP})
    taken |= std::uint64_t{1} << (signal - 1);
  EXPECT_EQ(std::strtoull(blocked.c_str(), nullptr, 16), ~taken) << blocked;
}

TEST(Thread, RefusedThreadIsAnErrorWithTheRemedy) {
  const auto refused = [] {
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    setrlimit(RLIMIT_NPROC, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(1);  // root has no such limit
    const auto thread = start_thread("tact-x", [] {});
    std::fputs(thread ? "it runs" : thread.error().message.c_str(), stderr);
    _exit(thread ? 0 : 3);
  };
  EXPECT_EXIT(refused(), testing::ExitedWithCode(3), "tact-x cannot be started.*ulimit -u");
}

TEST(Thread, ExceptionEndsTheProcessWithTheThreadName) {
  const auto throws = [] {
    auto thread = start_thread("tact-x", [] { throw std::bad_alloc(); });
    thread->join();
    pause();
  };
  EXPECT_EXIT(throws(), testing::KilledBySignal(SIGTERM), "tact-x has ended .std::bad_alloc");
}

}  // namespace tact::hal::threads::thread_test
