// SPDX-License-Identifier: Apache-2.0
// The trap for heap calls is there in every build, and sees the calls of its own thread alone.
#include "firmware/loop/alloc_counter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

namespace tact::firmware::loop::alloc_counter_test {

// The compiler must not leave out an allocation that is not read.
template <class T>
void keep(T* block) {
  asm volatile("" : : "g"(block) : "memory");
}

class AllocCounter : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_count_heap_calls()) GTEST_SKIP() << "realtime sanitizer, or gcc's: nothing is counted";
  }
};

TEST_F(AllocCounter, SeesEveryKindOfHeapCall) {
  const auto calls_of = [](auto&& what) {
    const HeapCallCounter watch;
    what();
    return watch.calls();
  };
  int* before = new int(1);
  void* block = std::malloc(8);
  keep(block);
  EXPECT_GE(calls_of([&] { delete before; }), 1u);
  EXPECT_GE(calls_of([&] { keep(before = new int(2)); }), 1u);
  EXPECT_GE(calls_of([&] { keep(block = std::realloc(block, 4096)); }), 1u);
  EXPECT_GE(calls_of([&] { std::free(block); }), 1u);
  EXPECT_GE(calls_of([&] { keep(block = std::calloc(3, 8)); }), 1u);
  EXPECT_GE(
      calls_of([&] { std::vector<double>(100).swap(*std::make_unique<std::vector<double>>()); }),
      2u);
  EXPECT_EQ(calls_of([] {}), 0u);
  delete before;
  std::free(block);
}

TEST_F(AllocCounter, CountsAllocAndFreeOnceEach) {
  const HeapCallCounter watch;
  int* const block = new int(1);
  keep(block);
  EXPECT_EQ(watch.calls(), 1u);
  delete block;
  EXPECT_EQ(watch.calls(), 2u);
}

TEST_F(AllocCounter, DoesNotSeeOtherThreads) {
  std::atomic<bool> go{false}, done{false};
  std::thread other([&] {
    while (!go.load()) std::this_thread::yield();
    for (int i = 0; i < 1000; ++i) keep(std::make_unique<int>(i).get());
    done.store(true);
  });
  {
    const HeapCallCounter watch;
    go.store(true);
    while (!done.load()) std::this_thread::yield();
    EXPECT_EQ(watch.calls(), 0u);
  }
  other.join();
}

TEST_F(AllocCounter, EndsWithItsWatch) {
  {
    const HeapCallCounter watch;
  }
  keep(std::make_unique<int>(1).get());
  const HeapCallCounter watch;
  EXPECT_EQ(watch.calls(), 0u);
}

}  // namespace tact::firmware::loop::alloc_counter_test
