// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/real_device/guarded_play.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "firmware/run/loop_executor.h"
#include "model/time_ns.h"
#include "tools/program/interrupt.h"

namespace tact::tools::limits {
namespace {

constexpr auto kLook = std::chrono::milliseconds(100);

std::vector<firmware::run::LoopRun> runs_of(const Runs& runs, firmware::loop::Requests& requests,
                                            std::atomic<std::size_t>& done) {
  std::vector<firmware::run::LoopRun> out;
  for (const auto& run : runs)
    out.push_back({run->progress(), [&run, &requests, &done] {
                     if (run->play())
                       done.fetch_add(1);
                     else
                       requests.stop.store(true);
                   }});
  return out;
}

}  // namespace

firmware::run::ThreadCosts play_guarded(const Runs& runs, const LimitsBench& bench,
                                        firmware::watch::CallFilter* filter,
                                        const PlanProgress& progress) {
  firmware::loop::Requests& requests = *bench.requests;
  std::atomic<std::size_t> done{0};
  firmware::run::LoopExecutor executor({.runs = runs_of(runs, requests, done),
                                        .device = *bench.device,
                                        .lines = *bench.lines,
                                        .requests = requests,
                                        .filter = filter,
                                        .guardian = bench.guardian,
                                        .rt = {},
                                        .period_ns = model::period_ns(bench.scene.rate_Hz),
                                        .hard_real_time = bench.hard_real_time});
  while (!executor.ended()) {
    if (progress) progress(done.load(), runs.size());
    std::this_thread::sleep_for(kLook);
    // from here on it has to end: hangs() counts from the stop request
    if (program::is_interrupted() || requests.fault.load() != Fault::kNone ||
        done.load() == runs.size())
      requests.stop.store(true);
    // A call of the device that does not return holds the loop's thread: nothing here could end it.
    if (!executor.hangs()) continue;
    executor.leave_behind(1, [] {
      fmt::print(stderr,
                 "tact-limits: a call of the device does not come back, so it ends without a "
                 "report: switch the device's power off\n");
      std::fflush(stderr);
    });
  }
  if (const auto error = executor.join()) fmt::print(stderr, "tact-limits: {}\n", error->message);
  if (progress) progress(done.load(), runs.size());
  const Fault found = requests.fault.load();
  for (const auto& run : runs)
    // A case that never began failed for what the guards found, not for a reason of its own.
    if (found != Fault::kNone && run->rows().empty()) run->refuse(found);
  return executor.costs();
}

}  // namespace tact::tools::limits
