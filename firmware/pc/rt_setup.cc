// SPDX-License-Identifier: Apache-2.0
#include "firmware/pc/rt_setup.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "firmware/pc/pc_files.h"
#include "hal/rights_remedy.h"
#include "hal/threads/thread.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace tact::firmware::pc {
namespace {

// RT-2. Sizes chosen: MCL_FUTURE locks each whole stack; half of it is touched before the loop.
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
constexpr std::size_t kTouchedStackBytes = std::size_t{128} * 1024;

/// RT-2. Configures glibc's allocator, then locks the memory.
void lock_memory(std::vector<Shortfall>& shortfalls) {
  mallopt(M_TRIM_THRESHOLD, -1);  // never returns freed memory to the kernel
  mallopt(M_MMAP_MAX, 0);         // no separate mappings, which free() would unmap
  mallopt(M_ARENA_MAX, 1);        // one heap, not one per thread
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return;
  shortfalls.push_back({fmt::format("memory is not locked ({}): {}; {}", std::strerror(errno),
                                    kMemoryReason, hal::rights_remedy())});
}

// RT-5. The kernel holds the latency while the file stays open.
int hold_power_latency(std::vector<Shortfall>& shortfalls) {
  const int fd = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t latency_us = 0;
  if (fd >= 0 && write(fd, &latency_us, sizeof latency_us) == sizeof latency_us) return fd;
  shortfalls.push_back({fmt::format("/dev/cpu_dma_latency: {}: {}; {}", std::strerror(errno),
                                    kPowerReason, hal::rights_remedy())});
  if (fd >= 0) close(fd);
  return -1;
}

/// The first touch of a stack page causes a page fault: take it here, not in a tick.
__attribute__((noinline)) void touch_stack() {
  // volatile keeps the writes; noinline places the frame where the loop's frames will be.
  volatile char bytes[kTouchedStackBytes];
  for (std::size_t i = 0; i < sizeof bytes; i += 1024) bytes[i] = 1;
  static_cast<void>(bytes[0]);
}

}  // namespace

int choose_core(const RtSettings& settings) {
  if (settings.core >= 0) return settings.core;
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  const auto isolated =
      parse_cpu_list(PcFiles{}.line("/sys/devices/system/cpu/isolated").value_or(""));
  // An isolated core regardless of the inherited affinity: it was isolated for this.
  if (!isolated.empty()) return isolated.back();
  int core = 0;
  for (int i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(static_cast<std::size_t>(i), &allowed)) core = i;
  return core;
}

ProcessSetup::ProcessSetup(std::vector<Shortfall>& shortfalls) {
  if (!is_realtime_kernel(PcFiles{}))
    shortfalls.push_back({fmt::format("the kernel is not PREEMPT_RT: {}; {}{}", kKernelReason,
                                      hal::container_of() ? "on the host: " : "", kKernelRemedy)});
  prctl(PR_SET_THP_DISABLE, 1, 0, 0,
        0);  // merging pages into huge ones unmaps them for a moment
  lock_memory(shortfalls);
  latency_fd_ = hold_power_latency(shortfalls);
}

ProcessSetup::~ProcessSetup() {
  if (latency_fd_ >= 0) close(latency_fd_);
}

void use_small_thread_stacks() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

void flush_denormals() {
#if defined(__x86_64__)
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
#endif
}

void enter_rt_thread(const RtSettings& settings, std::vector<Shortfall>& shortfalls) {
  flush_denormals();
  // RT-4: before the thread becomes FIFO.
  prctl(PR_SET_TIMERSLACK, 1);
  const int core = choose_core(settings);
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<std::size_t>(core), &cores);
  if (pthread_setaffinity_np(pthread_self(), sizeof cores, &cores) != 0)
    shortfalls.push_back(
        {fmt::format("core {} cannot be taken; choose another with --core", core)});
  const sched_param priority{.sched_priority = settings.priority};
  const int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  if (refused != 0)
    shortfalls.push_back(
        {fmt::format("SCHED_FIFO priority {} is refused ({}): {}; {}", settings.priority,
                     std::strerror(refused), kPriorityReason, hal::rights_remedy())});
  touch_stack();
}

void enter_watch_thread(const RtSettings& loop, std::vector<Shortfall>& shortfalls) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(getpid(), sizeof cores, &cores);  // of the main thread
  CPU_CLR(static_cast<std::size_t>(choose_core(loop)), &cores);
  // With only one core the watch shares it and relies on its priority.
  if (CPU_COUNT(&cores) > 0) pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
  const int wanted = loop.priority + kWatchAboveLoop;
  const sched_param priority{.sched_priority = wanted};
  // In a probe this thread was set up as the loop's before; if FIFO was refused then, it is not
  // reported twice.
  const bool loop_may = sched_getscheduler(0) == SCHED_FIFO;
  const int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  if (refused != 0 && loop_may)
    shortfalls.push_back(
        {fmt::format("SCHED_FIFO priority {} is refused ({}): the watch above the loop cannot stop "
                     "it in time; give the user rtprio {} in /etc/security/limits.d/",
                     wanted, std::strerror(refused), wanted)});
  touch_stack();
}

std::vector<Shortfall> probe_rt_threads(const RtSettings& loop) {
  std::vector<Shortfall> shortfalls;
  auto thread = hal::threads::start_thread("tact-probe", [&] {
    enter_rt_thread(loop, shortfalls);
    enter_watch_thread(loop, shortfalls);
  });
  if (!thread) return {{thread.error().message}};
  thread->join();
  return shortfalls;
}

void leave_rt_thread() {
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
}

}  // namespace tact::firmware::pc
