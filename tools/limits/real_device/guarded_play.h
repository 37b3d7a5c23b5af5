// SPDX-License-Identifier: Apache-2.0
// guarded_play.h - the cases of a plan on a real device, in real time, guarded as tactd's loop is:
// the watch above it, the runaway guard, the call filter, and a wait that ends
// (firmware/run/loop_executor.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "firmware/run/thread_costs.h"
#include "tools/limits/cases/case_run.h"

namespace tact::tools::limits {

using Runs = std::vector<std::unique_ptr<CaseRun>>;
/// How many cases are done, and of how many.
using PlanProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Case after case on the device, the lines and the requests of the bench; the device is stopped
/// behind them. What the guards find ends the plan: the cases that are left are refused for it. A
/// call of the device that does not come back ends the process, with status 1. `progress` is called
/// from this thread. `filter`: null: any call is allowed.
firmware::run::ThreadCosts play_guarded(const Runs& runs, const LimitsBench& bench,
                                        firmware::watch::CallFilter* filter,
                                        const PlanProgress& progress);

}  // namespace tact::tools::limits
