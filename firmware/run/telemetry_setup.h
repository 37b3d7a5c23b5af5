// SPDX-License-Identifier: Apache-2.0
// telemetry_setup.h - opens all outputs of a run: viewer socket, hand socket, tick log, black box.
#pragma once

#include <memory>

#include "firmware/black_box/black_box.h"
#include "firmware/run/loop_parts.h"
#include "firmware/run/options.h"
#include "firmware/telemetry/telemetry.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Facts of the run before it starts.
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
  protocol::UtcOffset utc;                         // at the start
  std::unique_ptr<black_box::BlackBox> black_box;  // the target of sinks.recorder
  std::unique_ptr<hal::sim::HandSocket> hand;      // of a simulated device
  std::string no_black_box;  // the error, if the default folder is unusable; or of the history
};

/// Opens the outputs that the command line asks for; the others stay empty. An unusable folder for
/// the black box is an error only if --black-box names it; otherwise the run has no black box.
model::Result<Sinks> open_sinks(const RunSetup& run);

}  // namespace tact::firmware::run
