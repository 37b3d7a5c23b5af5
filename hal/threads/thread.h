// SPDX-License-Identifier: Apache-2.0
// thread.h - the one place where threads start: what the system refuses is an Error.
//
// No thread takes a signal but SIGSYS, SIGXCPU and those of its own crash: all others are for the
// thread that waits for them. No exception leaves a thread: it is reported, and the process is
// asked to end (SIGTERM).
#pragma once

#include <functional>
#include <thread>
#include <utility>

#include "model/result.h"

namespace tact::hal::threads {

/// A running thread, or none. The destructor joins it.
class Thread {
 public:
  Thread() = default;
  Thread(Thread&&) = default;
  Thread& operator=(Thread&&) = default;
  ~Thread() { join(); }

  bool joinable() const { return thread_.joinable(); }
  void join() {
    if (joinable()) thread_.join();
  }
  void detach() { thread_.detach(); }

 private:
  friend model::Result<Thread> start_thread(const char* name, std::function<void()> body);
  explicit Thread(std::thread thread) : thread_(std::move(thread)) {}

  std::thread thread_;
};

/// `name`: of at most 15 characters, for top(1).
model::Result<Thread> start_thread(const char* name, std::function<void()> body);

}  // namespace tact::hal::threads
