// SPDX-License-Identifier: Apache-2.0
// register_tracker.h - tact-view --register: finds where the tracker stands from poses of the
// tracked tool, while tactd runs, and writes SCENE.registration.toml.
#pragma once

#include "host/run/command_line.h"

namespace tact::host::run {

/// Until enough poses are taken or Ctrl-C. The program's exit status: 0 written, 1 written though a
/// residual is above 2 mm, or refused, 2 bad input.
int register_tracker(const Options& options);

}  // namespace tact::host::run
