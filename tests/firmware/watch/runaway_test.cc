// SPDX-License-Identifier: Apache-2.0
// The limit of a session on real-time threads, in processes of their own: a limit that is lowered
// stays so.
#include "firmware/watch/runaway.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace tact::firmware::watch::runaway_test {

constexpr rlim_t kShort_us = 300'000;

void limit_to(rlim_t now_us, rlim_t most_us) {
  const rlimit limit{.rlim_cur = now_us, .rlim_max = most_us};
  if (setrlimit(RLIMIT_RTTIME, &limit) != 0) std::exit(9);
}

// Root without it may raise no limit either.
void drop_the_right_to_raise_limits() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct data[2] = {};
  if (syscall(SYS_capget, &header, data) != 0) std::exit(9);
  data[0].effective &= ~(1U << CAP_SYS_RESOURCE);
  data[0].permitted &= ~(1U << CAP_SYS_RESOURCE);
  if (syscall(SYS_capset, &header, data) != 0) std::exit(9);
}

rlim_t limit_now_us() {
  rlimit limit{};
  getrlimit(RLIMIT_RTTIME, &limit);
  return limit.rlim_cur;
}

[[noreturn]] void leave(bool good) { std::exit(good ? 0 : 1); }

TEST(RttimeLimit, IsLiftedWhereTheSessionMayRaiseIt) {
  const auto lifted = [] {
    limit_to(kShort_us, RLIM_INFINITY);
    drop_the_right_to_raise_limits();
    leave(lift_time_limits().empty() && limit_now_us() == RLIM_INFINITY);
  };
  EXPECT_EXIT(lifted(), testing::ExitedWithCode(0), "");
}

TEST(RttimeLimit, LimitThatCannotBeLiftedIsRaisedToTheMaximumAndReported) {
  const auto reported = [] {
    limit_to(kShort_us / 2, kShort_us);
    drop_the_right_to_raise_limits();
    const rlimit cpu{.rlim_cur = 100, .rlim_max = 3600};
    setrlimit(RLIMIT_CPU, &cpu);
    const auto kept = lift_time_limits();
    rlimit now{};
    getrlimit(RLIMIT_CPU, &now);
    leave(kept.size() == 2 && kept[0].message.find("after 300000 us") != std::string::npos &&
          kept[1].message.find("after 3600 s of CPU time") != std::string::npos &&
          limit_now_us() == kShort_us && now.rlim_cur == 3600);
  };
  EXPECT_EXIT(reported(), testing::ExitedWithCode(0), "");
}

TEST(RttimeLimit, UnlimitedSessionIsLeftAlone) {
  const auto none = [] {
    if (limit_now_us() != RLIM_INFINITY) limit_to(RLIM_INFINITY, RLIM_INFINITY);
    leave(lift_time_limits().empty() && limit_now_us() == RLIM_INFINITY);
  };
  EXPECT_EXIT(none(), testing::ExitedWithCode(0), "");
}

TEST(RunawayGuard, ASignalThatComesAfterItEndsNothing) {
  const auto late = [] {
    loop::Requests requests;
    {
      const RunawayGuard guard(requests);
    }
    std::raise(SIGXCPU);
    leave(requests.fault.load() == model::Fault::kNone && !requests.stop.load());
  };
  EXPECT_EXIT(late(), testing::ExitedWithCode(0), "");
}

}  // namespace tact::firmware::watch::runaway_test
