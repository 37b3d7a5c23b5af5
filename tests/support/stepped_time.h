// SPDX-License-Identifier: Apache-2.0
// stepped_time.h - a loop beside threads of a vendor SDK, on a machine that may be busy.
//
// From its first question for the time CLOCK_MONOTONIC stops for all of the program, until
// the loop sleeps: then it is the loop's deadline. So no sample and no command grows old while a
// thread waits for a core. A sleep of the loop lasts until another thread has gone through two of
// its own, and so through a whole cycle that began after this one's tick. To deadlines the others
// sleep 0.2 ms of real time. One at a time; stepped_time.cc takes the place of the C library's
// functions, in programs that link it.
#pragma once

#include "firmware/loop/clock.h"
#include "model/rt.h"

namespace tact::tests {

class SteppedTime final : public firmware::loop::Clock {
 public:
  SteppedTime();  // on the thread of the loop
  SteppedTime(const SteppedTime&) = delete;
  SteppedTime& operator=(const SteppedTime&) = delete;
  ~SteppedTime() override;

  std::int64_t now_ns() RT_SAFE override;
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override;

 private:
  firmware::loop::MonotonicClock real_;
};

}  // namespace tact::tests
