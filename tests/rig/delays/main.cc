// SPDX-License-Identifier: Apache-2.0
// tact-rig-delays: delays the loop by a cause of one's choice at deadlines of its grid, and says at
// which: what a tool that names causes is evaluated against. One line each: cause, deadline in
// CLOCK_MONOTONIC ns.
//
// Source of the stall: Intel SDM volume 3, "System Management Mode"; 82441FX data sheet, SMRAM.
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/io.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace tact::rig {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000, kEvery = 20;  // periods from one delay to the next

struct Plan {
  std::int64_t grid_ns = 0;
  int count = 0, tactd = 0;
  std::mt19937 random;

  std::int64_t between(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  }
};

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

timespec time_of(std::int64_t ns) { return {ns / 1'000'000'000, ns % 1'000'000'000}; }

void sleep_until(std::int64_t ns) {
  const timespec at = time_of(ns);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

void run_at(int priority, const char* name) {
  const sched_param parameter{.sched_priority = priority};
  if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0) throw std::runtime_error("no SCHED_FIFO");
  prctl(PR_SET_NAME, name);
}

void report(const char* cause, std::int64_t due_ns) { fmt::print("{} {}\n", cause, due_ns); }

/// Calls act(deadline) for each deadline that is to be hit, some 15 periods before it.
void for_each_deadline(const Plan& plan, const std::function<void(std::int64_t)>& act) {
  std::int64_t due_ns =
      plan.grid_ns + ((now_ns() - plan.grid_ns) / kPeriod_ns + kEvery) * kPeriod_ns;
  for (int i = 0; i < plan.count; ++i, due_ns += kEvery * kPeriod_ns) act(due_ns);
}

/// A thread of a higher priority computes across the deadline.
void delay_by_thread(Plan& plan) {
  run_at(90, "delay-thread");
  for_each_deadline(plan, [&](std::int64_t due_ns) {
    sleep_until(due_ns - plan.between(10'000, 400'000));
    const std::int64_t end_ns = due_ns + plan.between(100'000, 450'000);
    while (now_ns() < end_ns) {
    }
    report("thread", due_ns);
  });
}

/// The timers of many real-time threads expire in one interrupt.
void delay_by_interrupt(Plan& plan) {
  run_at(2, "delay-interrupt");
  std::vector<std::int64_t> deadlines;
  for_each_deadline(
      plan, [&](std::int64_t due_ns) { deadlines.push_back(due_ns + kEvery * kPeriod_ns); });
  std::vector<std::thread> sleepers;
  for (int i = 0; i < 250; ++i)
    sleepers.emplace_back([&] {
      run_at(1, "sleeper");
      for (const std::int64_t due_ns : deadlines) sleep_until(due_ns - 2'000);
    });
  for (std::thread& sleeper : sleepers) sleeper.join();
  for (const std::int64_t due_ns : deadlines) report("interrupt", due_ns);
}

/// The timers of many descriptors expire in the softirq of a thread that was raised above the loop.
void delay_by_softirq(Plan& plan) {
  constexpr int kTimers = 250;
  const rlimit descriptors{kTimers + 100, kTimers + 100};
  setrlimit(RLIMIT_NOFILE, &descriptors);
  run_at(2, "delay-softirq");
  std::vector<int> timers;
  for (int i = 0; i < kTimers; ++i) timers.push_back(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK));
  for_each_deadline(plan, [&](std::int64_t due_ns) {
    const itimerspec at{.it_interval = {},
                        .it_value = time_of(due_ns - plan.between(2'000, 100'000))};
    for (const int timer : timers) timerfd_settime(timer, TFD_TIMER_ABSTIME, &at, nullptr);
    sleep_until(due_ns + 2 * kPeriod_ns);
    report("softirq", due_ns);
  });
}

/// Every page of the loop's process is made read-only for the kernel's own book-keeping: the next
/// write of each faults.
void delay_by_fault(Plan& plan) {
  run_at(2, "delay-fault");
  const int refs =
      open(fmt::format("/proc/{}/clear_refs", plan.tactd).c_str(), O_WRONLY | O_CLOEXEC);
  for_each_deadline(plan, [&](std::int64_t due_ns) {
    sleep_until(due_ns - 700'000);
    if (write(refs, "4", 1) != 1) throw std::runtime_error("no soft-dirty bits");
    report("fault", due_ns);
  });
}

/// A handler in SMRAM that counts down, with interrupts off, and no software of the system aware of
/// it.
class Smram {
 public:
  Smram() {
    const int memory = open("/dev/mem", O_RDWR | O_SYNC | O_CLOEXEC);
    void* at = mmap(nullptr, 0x1000, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0xa8000);
    if (iopl(3) != 0 || at == MAP_FAILED) throw std::runtime_error("no /dev/mem or ports");
    entry_ = static_cast<unsigned char*>(at);
  }
  void plant(std::uint32_t turns) {
    std::array<unsigned char, 12> code{0x66, 0xb9, 0, 0, 0, 0, 0x66, 0x49, 0x75, 0xfc, 0x0f, 0xaa};
    std::memcpy(&code[2], &turns, sizeof turns);  // mov ecx, turns; dec ecx; jnz -4; rsm
    const unsigned char closed = smram(0x4a);     // open, enabled, at 0xa0000
    for (std::size_t i = 0; i < code.size(); ++i) entry_[i] = code[i];
    smram(closed);
  }
  void enter() { outb(0, 0xb2); }  // the port of APM raises an SMI

 private:
  static unsigned char smram(unsigned char value) {
    outl(0x80000000U | 0x70, 0xcf8);
    const unsigned char before = inb(0xcfc + 2);
    outb(value, 0xcfc + 2);
    return before;
  }
  volatile unsigned char* entry_ = nullptr;
};

void delay_by_stall(Plan& plan) {
  run_at(2, "delay-stall");
  Smram smram;
  for_each_deadline(plan, [&](std::int64_t due_ns) {
    const std::int64_t before_ns = plan.between(20'000, 300'000),
                       after_ns = plan.between(100'000, 450'000);
    smram.plant(static_cast<std::uint32_t>((before_ns + after_ns) / 2));  // one instruction is 1 ns
    sleep_until(due_ns - before_ns);
    smram.enter();
    report("stall", due_ns);
  });
}

}  // namespace
}  // namespace tact::rig

int main(int argc, char** argv) {
  using tact::rig::Plan;
  const std::map<std::string, void (*)(Plan&)> causes{{"thread", tact::rig::delay_by_thread},
                                                      {"interrupt", tact::rig::delay_by_interrupt},
                                                      {"softirq", tact::rig::delay_by_softirq},
                                                      {"fault", tact::rig::delay_by_fault},
                                                      {"stall", tact::rig::delay_by_stall}};
  CLI::App app{
      "tact-rig-delays: delays the loop by a cause of one's choice, and says at which deadlines."};
  Plan plan;
  std::string cause;
  std::uint32_t seed = 1;
  std::vector<std::string> names;
  for (const auto& [name, act] : causes) names.push_back(name);
  app.add_option("CAUSE", cause)->required()->check(CLI::IsMember(names));
  app.add_option("--grid", plan.grid_ns, "a deadline of the loop, CLOCK_MONOTONIC, ns")->required();
  app.add_option("--count", plan.count, "delays")->required();
  app.add_option("--tactd", plan.tactd, "its process");
  app.add_option("--seed", seed, "of their lengths");
  CLI11_PARSE(app, argc, argv);
  plan.random.seed(seed);
  mlockall(MCL_CURRENT);  // not the stacks of many threads
  try {
    causes.at(cause)(plan);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tact-rig-delays: {}\n", error.what());
    return 2;
  }
  return 0;
}
