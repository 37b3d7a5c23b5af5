// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/measure/instructions.h"

#include <linux/perf_event.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <limits>
#include <new>

#include "tools/program/interrupt.h"

namespace tact::tools::chart {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
using Call = std::function<void()>;

int open_counter() {
  perf_event_attr wanted{};
  wanted.type = PERF_TYPE_HARDWARE;
  wanted.size = sizeof(wanted);
  wanted.config = PERF_COUNT_HW_INSTRUCTIONS;
  // An interrupt or a page fault is the machine's, not the call's.
  wanted.exclude_kernel = 1;
  wanted.exclude_hv = 1;
  constexpr int kThisThread = 0, kAnyCore = -1, kNoGroup = -1;
  return static_cast<int>(
      syscall(SYS_perf_event_open, &wanted, kThisThread, kAnyCore, kNoGroup, 0));
}

double by_counter(int counter, const Call& call, std::size_t calls) {
  std::uint64_t before = 0, after = 0;
  bool good = read(counter, &before, sizeof(before)) == sizeof(before);
  for (std::size_t i = 0; i < calls; ++i) call();
  good = good && read(counter, &after, sizeof(after)) == sizeof(after);
  return good ? static_cast<double>(after - before) / static_cast<double>(calls) : kUnknown;
}

/// What the copy reports to the process that steps it.
struct Progress {
  std::atomic<std::uint64_t> calls{0};
};

[[noreturn]] void be_stepped(const Call& call, std::size_t calls, Progress& progress) {
  ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
  // From here on the parent steps it.
  raise(SIGSTOP);
  for (std::size_t i = 0; i <= calls; ++i) {  // one more: the first only starts the count
    call();
    progress.calls.fetch_add(1, std::memory_order_relaxed);
  }
  _exit(0);
}

/// Steps the stopped child; instructions from the end of its first call to the end of its last.
double step(pid_t child, const Progress& progress, std::size_t most_steps) {
  std::uint64_t seen = 0, first = 0, last = 0;
  for (std::uint64_t steps = 1; steps <= most_steps; ++steps) {
    int status = 0;
    if (steps % 1000 == 0 && program::is_interrupted()) break;
    if (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0 ||
        waitpid(child, &status, 0) != child || !WIFSTOPPED(status))
      break;
    const std::uint64_t now = progress.calls.load(std::memory_order_relaxed);
    // Counted by the calls that have ended: no breakpoint is needed.
    if (now == seen) continue;
    if (seen == 0) first = steps;
    last = steps;
    seen = now;
  }
  // However far it came: it must not run on as a second copy of this program.
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return seen > 1 ? static_cast<double>(last - first) / static_cast<double>(seen - 1) : kUnknown;
}

/// Both processes on one core while it lives: a step then wakes no other core, twenty times
/// quicker.
class OneCore {
 public:
  OneCore() {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &here);
    sched_setaffinity(0, sizeof(here), &here);
  }
  ~OneCore() { sched_setaffinity(0, sizeof(before_), &before_); }
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;

 private:
  cpu_set_t before_{};
};

double stepped(const Call& call, std::size_t calls, std::size_t most_steps) {
  const OneCore here;
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return kUnknown;
  auto* progress = new (shared) Progress;
  double count = kUnknown;
  const pid_t child = fork();
  if (child == 0) be_stepped(call, calls, *progress);
  int status = 0;
  if (child > 0 && waitpid(child, &status, WUNTRACED) == child && WIFSTOPPED(status))
    count = step(child, *progress, most_steps);
  munmap(shared, sizeof(Progress));
  return count;
}

}  // namespace

double instructions_by_steps(const Call& call, std::size_t calls, std::size_t most_steps) {
  static const double loop = stepped([] {}, 10, kMaxSteps);  // of the counting itself
  const double count = stepped(call, calls, most_steps) - loop;
  return count < 0.0 ? 0.0 : count;  // and NaN stays NaN
}

double instructions_per_call(const Call& call, std::size_t calls) {
  const int counter = open_counter();
  const double counted = counter < 0 ? kUnknown : by_counter(counter, call, calls);
  if (counter >= 0) close(counter);
  return counted >= 0.0 ? counted : instructions_by_steps(call, calls);
}

}  // namespace tact::tools::chart
