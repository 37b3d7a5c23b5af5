// SPDX-License-Identifier: Apache-2.0
// telemetry_setup.h - everything that leaves a run: viewer socket, hand socket, tick log, black
// box.
#pragma once

#include <memory>
#include <optional>

#include "firmware/black_box/black_box.h"
#include "firmware/run/loop_parts.h"
#include "firmware/run/options.h"
#include "firmware/telemetry/telemetry.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// What is known of the run before it starts.
struct RunSetup {
  const model::scene::Scene& scene;
  const Options& options;
  const LoopParts& parts;
  std::int64_t period_ns = 0;
  double force_share = 1.0;
  bool non_rt = false;
};

struct Sinks {
  telemetry::Sinks sinks;
  std::unique_ptr<black_box::BlackBox> black_box;  // sinks.recorder, where there is one
  std::unique_ptr<hal::sim::HandSocket> hand;      // of a simulated device
  std::string no_black_box;                        // why there is none although nobody declined it
};

/// What the command line asks for; the rest stays empty. A black box whose usual folder cannot be
/// written is done without; one that was asked for is an error.
model::Result<Sinks> open_sinks(const RunSetup& run);

}  // namespace tact::firmware::run
