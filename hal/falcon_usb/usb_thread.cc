// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/usb_thread.h"

#include <sched.h>

#include <csignal>
#include <ctime>

#include "model/time_ns.h"

namespace tact::hal::falcon_usb {
namespace {

// Small on purpose: MCL_FUTURE locks the whole of it in memory.
constexpr std::size_t kStack_bytes = 131'072;

}  // namespace

int UsbThread::start(void (*body)(void*), void* argument) {
  body_ = body;
  argument_ = argument;
  pthread_attr_t attributes;
  if (const int error = pthread_attr_init(&attributes); error != 0) return error;
  pthread_attr_setstacksize(&attributes, kStack_bytes);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // the thread inherits it
  const int error = pthread_create(&thread_, &attributes, enter, this);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  joinable_ = error == 0;
  return error;
}

void* UsbThread::enter(void* self) {
  auto& thread = *static_cast<UsbThread*>(self);
  pthread_setname_np(pthread_self(), "tact-usb");
  const sched_param fifo{.sched_priority = kUsbThreadPriority};
  // Not checked: a refusal leaves normal priority, which still works, only later.
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &fifo);
  thread.body_(thread.argument_);
  const sched_param other{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &other);
  int policy = -1;
  sched_param now{};
  pthread_getschedparam(pthread_self(), &policy, &now);
  thread.last_policy_.store(policy, std::memory_order_release);
  thread.ended_.store(true, std::memory_order_release);
  return nullptr;
}

void UsbThread::join() {
  if (!joinable_) return;
  joinable_ = false;
  pthread_join(thread_, nullptr);
}

void usb_pause_ns(std::int64_t pause_ns) {
  const timespec t{.tv_sec = pause_ns / model::kSecond_ns, .tv_nsec = pause_ns % model::kSecond_ns};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &t, nullptr);
}

}  // namespace tact::hal::falcon_usb
