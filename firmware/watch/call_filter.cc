// SPDX-License-Identifier: Apache-2.0
#include "firmware/watch/call_filter.h"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/syscall.h>
#include <ucontext.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "firmware/loop/alloc_counter.h"
#include "hal/threads/thread.h"

namespace tact::firmware::watch {
namespace {

using model::Error;
using model::Result;

// Sleep, clock, return from a signal handler; then what glibc needs to end a thread.
constexpr std::array kEveryLoop{
    SYS_clock_nanosleep, SYS_clock_gettime, SYS_restart_syscall, SYS_rt_sigreturn,
    SYS_rt_sigprocmask,  SYS_getrusage,     SYS_madvise,         SYS_exit};

// SYS_SECCOMP of the kernel's headers, which cannot be included together with those of glibc.
constexpr int kSeccompCode = 1;

// Read by a signal handler in the loop's thread, so lock-free. The default memory order is enough:
// the handler is not time-critical.
std::atomic<loop::Requests*> filter_requests{nullptr};
std::atomic<int> refused{-1};  // number of the first refused call
thread_local bool in_loop = false;

// Sets the return value of the refused call.
[[maybe_unused]] constexpr bool kCanAnswerRefusedCall =
#if defined(__x86_64__) || defined(__aarch64__)
    true;
#else
    false;
#endif
void answer([[maybe_unused]] ucontext_t& context, [[maybe_unused]] long long result) {
#if defined(__x86_64__)
  context.uc_mcontext.gregs[REG_RAX] = result;
#elif defined(__aarch64__)
  context.uc_mcontext.regs[0] = static_cast<unsigned long long>(result);
#endif
}

// Runs in the calling thread; lock-free stores only. A lock wait returns EAGAIN, because glibc
// takes any other error for corrupted memory.
void on_refused(int, siginfo_t* info, void* context) {
  if (info->si_code != kSeccompCode) return;  // sent by kill(): no call was made
  answer(*static_cast<ucontext_t*>(context), info->si_syscall == SYS_futex ? -EAGAIN : -EPERM);
  loop::Requests* requests = filter_requests.load();
  if (requests == nullptr || !in_loop) return;
  int none = -1;
  // Only the first call is reported: later refusals may be its consequence.
  refused.compare_exchange_strong(none, info->si_syscall);
  requests->trip(model::Fault::kForbiddenCall);
}

struct Release {
  void operator()(scmp_filter_ctx context) const { seccomp_release(context); }
};
using Context = std::unique_ptr<void, Release>;

/// EEXIST is no error: device and lines may list the same call.
bool allow(void* filter, std::span<const int> calls) {
  for (const int call : calls) {
    const int failed = seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
    if (failed != 0 && failed != -EEXIST) return false;
  }
  return true;
}

bool allow_with(void* filter, int call, unsigned argument, scmp_datum_t mask, scmp_datum_t value) {
  const scmp_arg_cmp only{
      .arg = argument, .op = SCMP_CMP_MASKED_EQ, .datum_a = mask, .datum_b = value};
  return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &only) == 0;
}

Error no_filter(const char* why) {
  return Error{fmt::format("the loop's system calls are not filtered: {}", why)};
}

class Filter final : public CallFilter {
 public:
  Filter(Context context, loop::Requests& requests) : context_(std::move(context)) {
    refused.store(-1);
    filter_requests.store(&requests);
    struct sigaction action{};
    action.sa_sigaction = on_refused;
    // SIGSYS carries the call's number (si_syscall). Without a handler it would end the process.
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSYS, &action, nullptr);
  }
  ~Filter() override { filter_requests.store(nullptr); }

  int enter_thread() override {
    const int refused_by_kernel = -seccomp_load(context_.get());  // frees memory, already filtered
    in_loop = refused_by_kernel == 0;
    return refused_by_kernel;
  }
  void leave_loop() override { in_loop = false; }

 private:
  Context context_;
};

}  // namespace

Result<std::unique_ptr<CallFilter>> CallFilter::make(std::span<const int> of_device,
                                                     std::span<const int> of_lines,
                                                     loop::Requests& requests) {
  if (!kCanAnswerRefusedCall) return no_filter("it is not made for this processor");
  if (loop::is_sanitized()) return no_filter("a sanitizer makes calls of its own");
  // TRAP, not KILL: the call fails, and the loop can still write zero force.
  Context context(seccomp_init(SCMP_ACT_TRAP));
  constexpr scmp_datum_t kWhole = ~scmp_datum_t{0},
                         kCommand = static_cast<unsigned>(FUTEX_CMD_MASK);
  std::array<int, kEveryLoop.size()> every{};
  for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<int>(kEveryLoop[i]);
  // By argument: FUTEX_WAKE with any flags, and at the end the return to SCHED_OTHER.
  const bool good = context != nullptr && allow(context.get(), every) &&
                    allow(context.get(), of_device) && allow(context.get(), of_lines) &&
                    allow_with(context.get(), SYS_futex, 1, kCommand, FUTEX_WAKE) &&
                    allow_with(context.get(), SYS_sched_setscheduler, 1, kWhole, SCHED_OTHER);
  if (!good) return no_filter("libseccomp cannot make it");
  std::unique_ptr<CallFilter> filter(new Filter(std::move(context), requests));
  int refused_by_kernel = 0;  // tried in a short-lived thread, as a filter cannot be removed
  auto thread = hal::threads::start_thread("tact-filter", [&] {
    refused_by_kernel = filter->enter_thread();
    filter->leave_loop();
  });
  if (!thread) return thread.error();
  thread->join();
  if (refused_by_kernel != 0) return no_filter(std::strerror(refused_by_kernel));
  return filter;
}

std::string refused_call() {
  const int call = refused.load();
  if (call < 0) return {};
  char* name = seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, call);
  std::string text =
      name == nullptr ? fmt::format("system call {}", call) : fmt::format("{}({})", name, call);
  std::free(name);  // allocated by libseccomp
  return text;
}

}  // namespace tact::firmware::watch
