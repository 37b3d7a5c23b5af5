// SPDX-License-Identifier: Apache-2.0
// patient_poll: loaded into QEMU (LD_PRELOAD), keeps its main loop asleep while the guest computes.
//
// While idle guest time is skipped (-icount sleep=off), QEMU 7.2's main loop moves the clock on
// when it finds the virtual CPU halted. It also looks when its own poll times out or wakes for
// nothing, and if that falls between the guest's `hlt` and the CPU thread's account of the
// instructions before it, they are counted after the jump: one wake-up is a microsecond late, and
// the run is no longer the same. A busy host makes that happen every few seconds. So here
//   - a time-out becomes one second: the CPU thread wakes the main loop each time it goes idle;
//   - a poll returns once the CPU thread waits on its condition, or after a second;
//   - or once, when the CPU thread has written to the same eventfd twice at the same guest time:
//     it reports that a timer is due, could not run it itself, and reports again. No instruction
//     runs before the main loop has looked. Without this each such timer cost a second of this
//     host's time, half of the bench's.
// The CPU thread holds QEMU's big lock when it says that it is idle and gives it up in the wait
// itself, so the main loop, which takes that lock next, finds all instructions accounted.
//
// Source: QEMU 7.2, softmmu/icount.c icount_start_warp_timer(), accel/tcg/tcg-accel-ops-icount.c
// icount_handle_deadline(), util/main-loop.c main_loop_wait(),
// accel/tcg/tcg-accel-ops-rr.c rr_cpu_thread_fn().
#include <dlfcn.h>
#include <linux/futex.h>
#include <poll.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

namespace {

constexpr timespec kSecond{.tv_sec = 1, .tv_nsec = 0};
constexpr int kVirtualClock = 1;  // of QEMUClockType
// What the CPU thread does. kIdle also before it lives.
constexpr std::uint32_t kComputes = 0, kIdle = 1, kStuck = 2;
std::atomic<std::uint32_t> cpu{kIdle};
static_assert(sizeof cpu == sizeof(std::uint32_t));

void futex(int operation, std::uint32_t value, const timespec* limit) {
  syscall(SYS_futex, &cpu, operation | FUTEX_PRIVATE_FLAG, value, limit, nullptr, 0);
}

/// Of the one thread that runs all virtual CPUs, "ALL CPUs/TCG" (-name debug-threads=on).
bool is_cpu_thread() {
  static thread_local const bool answer = [] {
    char name[16] = {};
    prctl(PR_GET_NAME, name);
    return std::strstr(name, "/TCG") != nullptr;
  }();
  return answer;
}

void report(std::uint32_t state) {
  cpu.store(state);
  futex(FUTEX_WAKE, INT_MAX, nullptr);
}

}  // namespace

extern "C" int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  using Function = int (*)(pthread_cond_t*, pthread_mutex_t*);
  static const auto real =
      reinterpret_cast<Function>(dlvsym(RTLD_NEXT, "pthread_cond_wait", "GLIBC_2.3.2"));
  if (!is_cpu_thread()) return real(condition, mutex);
  report(kIdle);
  const int result = real(condition, mutex);
  cpu.store(kComputes);
  return result;
}

/// When a timer is due the CPU thread writes to each eventfd of the main loop, then runs those
/// timers that it may: to be stuck is to write to the first one again. It writes outside of guest
/// code, or in an instruction of its own, where QEMU lets the clock be read.
extern "C" ssize_t write(int file, const void* data, std::size_t size) {
  using Function = ssize_t (*)(int, const void*, std::size_t);
  using Now = std::int64_t (*)(int);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "write"));
  static const auto now_ns =
      reinterpret_cast<Now>(dlsym(RTLD_DEFAULT, "qemu_clock_get_ns"));  // null: slower
  const ssize_t written = real(file, data, size);
  if (now_ns == nullptr || size != sizeof(std::uint64_t) || !is_cpu_thread()) return written;
  static std::int64_t before_ns = -1;
  static int first = -1;  // eventfd of that time
  const std::int64_t at_ns = now_ns(kVirtualClock);
  if (at_ns == before_ns && file == first) report(kStuck);
  if (at_ns != before_ns) first = file;
  before_ns = at_ns;
  return written;
}

extern "C" int ppoll(pollfd* files, nfds_t count, const timespec* limit, const sigset_t* mask) {
  using Function = int (*)(pollfd*, nfds_t, const timespec*, const sigset_t*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "ppoll"));
  const bool is_main = gettid() == getpid();
  std::uint32_t state = kStuck;  // of before; one that still is reports it again
  if (is_main) cpu.compare_exchange_strong(state, kComputes);
  const bool shorter = limit != nullptr && limit->tv_sec == 0 && limit->tv_nsec > 0;
  const int ready = real(files, count, shorter ? &kSecond : limit, mask);
  if (is_main && cpu.load() == kComputes) futex(FUTEX_WAIT, kComputes, &kSecond);
  return ready;
}
