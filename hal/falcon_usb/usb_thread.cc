// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/usb_thread.h"

#include <pthread.h>
#include <sched.h>

#include <ctime>
#include <utility>

#include "model/time_ns.h"

namespace tact::hal::falcon_usb {

std::optional<model::Error> UsbThread::start(std::function<void()> body) {
  auto thread = threads::start_thread("tact-usb", [this, body = std::move(body)] {
    const sched_param fifo{.sched_priority = kUsbThreadPriority};
    // Not checked: a refusal leaves normal priority, which still works, only later.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &fifo);
    body();
    const sched_param other{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &other);
    int policy = -1;
    sched_param now{};
    pthread_getschedparam(pthread_self(), &policy, &now);
    last_policy_.store(policy, std::memory_order_release);
    ended_.store(true, std::memory_order_release);
  });
  if (!thread) return thread.error();
  thread_ = std::move(*thread);
  return std::nullopt;
}

void usb_pause_ns(std::int64_t pause_ns) {
  const timespec t{.tv_sec = pause_ns / model::kSecond_ns, .tv_nsec = pause_ns % model::kSecond_ns};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &t, nullptr);
}

}  // namespace tact::hal::falcon_usb
