// SPDX-License-Identifier: Apache-2.0
// fix.h - tact-doctor --fix and --undo: tells all that it will do, asks, then does it.
#pragma once

#include <string>

#include "model/result.h"
#include "tools/doctor/fix_plan.h"

namespace tact::tools::doctor {

struct FixOptions {
  std::string root;      // files below it, and no command is run; empty: this PC
  bool dry_run = false;  // tells alone
  bool yes = false;      // does not ask
};

/// Who asked by sudo and is not in the group haptics yet, and whether there is that group.
FixPeople people_of_this_pc();

/// The exit status: 0 done, or nothing to do; 1 not all of it, or the answer was no. An error
/// before anything was changed.
model::Result<int> fix(const FixPlan& plan, const FixOptions& options);
model::Result<int> undo(const FixOptions& options);

}  // namespace tact::tools::doctor
