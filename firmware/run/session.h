// SPDX-License-Identifier: Apache-2.0
// session.h - one run of tactd: a scene on its device, from set-up to report.
#pragma once

#include "firmware/run/options.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Runs until Ctrl-C or the requested time; a fault stops the force and is reported at the end.
/// Exit status: 0 good, 1 a fault or a refusal, 2 bad input.
int run_session(const model::scene::Scene& scene, const Options& options);

}  // namespace tact::firmware::run
