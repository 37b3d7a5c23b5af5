// SPDX-License-Identifier: Apache-2.0
#include "firmware/guardian/guardian_process.h"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <string_view>

#include "firmware/guardian/liveness_lock.h"
#include "firmware/guardian/orders.h"

namespace tact::firmware::guardian {
namespace {

constexpr std::uint32_t kRefuse = SCMP_ACT_ERRNO(EPERM);
// Chosen, deeper than the later calls need: a page touched and locked causes no fault later.
constexpr std::size_t kTouchedStack_bytes = std::size_t{64} * 1024;

/// Same as in pc/rt_setup.cc, which this small program does not link.
__attribute__((noinline)) void touch_stack() {
  volatile char bytes[kTouchedStack_bytes];
  for (std::size_t i = 0; i < sizeof bytes; i += 1024) bytes[i] = 1;
  static_cast<void>(bytes[0]);
}

/// Stops at an error: nothing could handle it here.
void write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = write(fd, text.data(), text.size());
    if (n <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Exempts this process from the out-of-memory killer. Only root may lower the score to -1000.
void outlive_short_memory() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  write_all(file, "-1000");
  close(file);
}

/// As far as this user's permissions allow; tactd has reported what is missing.
void enter_real_time(int priority) {
  touch_stack();
  mlockall(MCL_CURRENT | MCL_FUTURE);
  // RT-4: a timer slack of 1 ns, set before the thread becomes FIFO.
  prctl(PR_SET_TIMERSLACK, 1);
  const sched_param wanted{.sched_priority = priority};
  sched_setscheduler(0, SCHED_FIFO, &wanted);
}

/// Formatted in advance, so that nothing is formatted after the death.
struct DeathMessage {
  DeathMessage(int process, const char* how, const char* what) {
    std::snprintf(text.data(), text.size(), "tact-guardian: tactd (process %d) %s; %s\n", process,
                  how, what);
  }
  std::array<char, 200> text{};
};

scmp_arg_cmp is(unsigned argument, scmp_datum_t value) {
  return {.arg = argument, .op = SCMP_CMP_EQ, .datum_a = value, .datum_b = 0};
}

/// Allows this call with this descriptor as its first argument.
bool allow_on(void* filter, int call, int fd) {
  const scmp_arg_cmp only = is(0, static_cast<scmp_datum_t>(fd));
  return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &only) == 0;
}

bool allow_ioctl(void* filter, int fd, scmp_datum_t request) {
  const std::array only{is(0, static_cast<scmp_datum_t>(fd)), is(1, request)};
  return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, SYS_ioctl, 2, only.data()) == 0;
}

/// Any other call fails. On a kernel without filters the guardian runs unfiltered.
void filter_calls(int device, int socket) {
  void* filter = seccomp_init(kRefuse);
  if (filter == nullptr) return;
  bool good = true;
  // Waiting for the liveness lock, the clock (of a PC whose clock needs the kernel), the pause of a
  // millisecond between two steps, the exit, and the return from an interrupting signal.
  for (const int call : {SYS_futex, SYS_clock_gettime, SYS_clock_nanosleep, SYS_exit_group,
                         SYS_exit, SYS_restart_syscall, SYS_rt_sigreturn})
    good = good && seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
  // Shutdown frames over CAN take one call per step, those over USB transfers on its endpoint.
  good = good && allow_on(filter, SYS_sendmmsg, device) &&
         allow_ioctl(filter, device, USBDEVFS_BULK) &&
         allow_ioctl(filter, device, USBDEVFS_CLEAR_HALT);
  good = good && allow_on(filter, SYS_write, STDERR_FILENO) && allow_on(filter, SYS_write, socket);
  if (good) seccomp_load(filter);
  seccomp_release(filter);
}

}  // namespace

int stand_guard(int socket) {
  const auto taken = take_orders(socket);
  auto liveness = taken ? LivenessLock::take(taken->liveness_fd)
                        : model::Result<LivenessLock>(model::Error{"no orders"});
  if (!liveness) {
    write_all(STDERR_FILENO, "tact-guardian: tactd starts this program; do not start it by hand\n");
    return 2;
  }
  // In this order: calls for files and priority come before the filter, which would refuse
  // it; the ready byte "r" comes last.
  const Orders orders = taken->orders;
  constexpr const char *kDied = "died", *kHeld = "is held, or its loop stalls",
                       *kSent = "zero force and power off were sent to its device",
                       *kUnsent =
                           "its device did not take zero force and power off: switch it off now";
  const std::array<DeathMessage, 4> messages{{{orders.process, kDied, kUnsent},
                                              {orders.process, kDied, kSent},
                                              {orders.process, kHeld, kUnsent},
                                              {orders.process, kHeld, kSent}}};
  outlive_short_memory();
  enter_real_time(orders.priority);
  filter_calls(orders.frames.fd, socket);
  write_all(socket, "r");
  const LivenessLock::End end = liveness->await(orders.silence_ns, orders.period_ns);
  if (end == LivenessLock::End::kLetGo) return 0;
  const std::size_t sent = hal::send_all(orders.frames) == 0 ? 1 : 0;
  write_all(STDERR_FILENO,
            messages[sent + (end == LivenessLock::End::kSilent ? 2 : 0)].text.data());
  return 1;
}

}  // namespace tact::firmware::guardian
