// SPDX-License-Identifier: Apache-2.0
// Which system calls a loop's thread may make, asked of the kernel itself.
#include "firmware/watch/call_filter.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <map>
#include <mutex>

#include "firmware/loop/alloc_counter.h"
#include "tests/support/monitored_loop.h"

namespace tact::firmware::watch::call_filter_test {

class FilteredLoop : public MonitoredLoop {
 protected:
  void make(std::span<const int> of_device) {
    auto made = CallFilter::make(of_device, {}, requests);
    if (loop::is_sanitized() || prctl(PR_GET_SECCOMP) < 0)
      GTEST_SKIP() << "a sanitizer, or a kernel without seccomp";
    ASSERT_TRUE(made) << made.error().message;
    filter = std::move(*made);
  }
  void start_filtered() {
    start([this] { entered = filter->enter_thread(); }, [this] { filter->leave_loop(); });
  }
  // What the tick of that sample recorded; they are taken out of the ring in one go.
  model::Fault fault_of(std::uint64_t sequence) {
    loop::TickRecord record;
    while (ring->pop(record)) reported[record.input.sample.sequence] = record.output.fault;
    return reported.at(sequence);
  }
  std::map<std::uint64_t, model::Fault> reported;
  std::unique_ptr<CallFilter> filter;
  int entered = -1;
};

TEST_F(FilteredLoop, NeedsNoCallThatIsNotListed) {
  make({});
  if (filter == nullptr) return;
  start_filtered();
  finish();  // the end of its thread included
  EXPECT_EQ(entered, 0);
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone) << refused_call();
  EXPECT_EQ(refused_call(), "");
}

TEST_F(FilteredLoop, AForbiddenCallFailsAndStopsTheForceInTheSameTick) {
  make({});
  if (filter == nullptr) return;
  ASSERT_FALSE(watch.start({}));
  start_filtered();
  device.calls.store(true);
  ASSERT_TRUE(soon([this] { return lines.drops.load() > 0; })) << "the watch hears of it, too";
  finish();
  EXPECT_EQ(device.answer, -1) << "it did not reach the kernel";
  EXPECT_EQ(requests.fault.load(), model::Fault::kForbiddenCall);
  EXPECT_NE(refused_call().find("getppid"), std::string::npos) << refused_call();
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(fault_of(device.called_at), model::Fault::kForbiddenCall);
  EXPECT_EQ(fault_of(device.called_at - 1), model::Fault::kNone);
  EXPECT_GT(ask_parent(), 0) << "other threads call what they like";
}

TEST_F(FilteredLoop, ASignalFromAnotherProcessIsNoCall) {
  make({});
  if (filter == nullptr) return;
  start_filtered();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(syscall(SYS_tgkill, getpid(), gettid(), SIGSYS), 0);
  finish();
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
}

TEST_F(FilteredLoop, WhatTheDeviceListsPasses) {
  constexpr std::array kListed{static_cast<int>(SYS_getppid)};
  make(kListed);
  if (filter == nullptr) return;
  start_filtered();
  device.calls.store(true);
  ASSERT_TRUE(soon([this] { return !device.calls.load(); }));
  finish();
  EXPECT_EQ(device.answer, getppid());
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
}

TEST_F(FilteredLoop, ALockThatHadToBeWaitedForIsNoticed) {
  make({});
  if (filter == nullptr) return;
  std::mutex lock;
  lock.lock();
  thread = std::thread([&] {
    entered = filter->enter_thread();
    const std::lock_guard waits(lock);
    filter->leave_loop();
  });
  EXPECT_TRUE(soon([this] { return requests.fault.load() == model::Fault::kForbiddenCall; }));
  lock.unlock();
  thread.join();
  EXPECT_NE(refused_call().find("futex"), std::string::npos) << refused_call();
}

TEST_F(FilteredLoop, ACallWithoutANameIsReportedByItsNumber) {
  make({});
  if (filter == nullptr) return;
  constexpr long kNobodys = 5000;
  thread = std::thread([&] {
    entered = filter->enter_thread();
    syscall(kNobodys);
    filter->leave_loop();
  });
  thread.join();
  EXPECT_EQ(refused_call(), "system call 5000");
  EXPECT_EQ(requests.fault.load(), model::Fault::kForbiddenCall);
}

TEST_F(FilteredLoop, AThreadThatHasLeftTheLoopIsRefusedButTripsNothing) {
  make({});
  if (filter == nullptr) return;
  long in_the_loop_no_more = 0, of_a_filter_that_is_gone = 0;
  thread = std::thread([&] {
    entered = filter->enter_thread();
    filter->leave_loop();
    in_the_loop_no_more = ask_parent();
    filter.reset();
    of_a_filter_that_is_gone = ask_parent();
  });
  thread.join();
  EXPECT_EQ(in_the_loop_no_more, -1);
  EXPECT_EQ(of_a_filter_that_is_gone, -1);
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
}

TEST_F(FilteredLoop, NumbersThatAreNoCallMakeNoFilter) {
  make({});
  if (filter == nullptr) return;
  constexpr std::array kNone{-1};
  for (const bool of_device : {true, false}) {
    const auto made =
        CallFilter::make(of_device ? std::span<const int>(kNone) : std::span<const int>(),
                         of_device ? std::span<const int>() : kNone, requests);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().message,
              "the loop's system calls are not filtered: libseccomp cannot make it");
  }
}

}  // namespace tact::firmware::watch::call_filter_test
