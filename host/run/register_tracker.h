// SPDX-License-Identifier: Apache-2.0
// register_tracker.h - tact-view --register: finds the tracker's pose from poses of the tracked
// tool, while tactd runs, and writes SCENE.registration.toml.
#pragma once

#include "host/run/command_line.h"

namespace tact::host::run {

/// Runs until enough poses are taken or Ctrl-C. Exit status: 0 written, 1 refused, or written with
/// a residual above 2 mm, 2 bad input.
int register_tracker(const Options& options);

}  // namespace tact::host::run
