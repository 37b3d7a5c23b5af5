// SPDX-License-Identifier: Apache-2.0
// all_cores.h - a sweep of presses (model/scene/press_sweep.h) on all cores, with progress.
#pragma once

#include <span>

#include "model/result.h"
#include "model/scene/press_sweep.h"

namespace tact::tools::sweep {

/// As sweep_presses, to the same numbers; interruption() of run_program.h after Ctrl-C.
model::Result<model::scene::PressSweep> sweep_on_all_cores(
    const model::scene::Scene& scene, std::span<const model::scene::PressPoint> places,
    const model::scene::PressSettings& settings);

}  // namespace tact::tools::sweep
