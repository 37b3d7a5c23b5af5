// telemetry_setup.h - everything that leaves a run: viewer socket, hand socket, tick log, black
// box.
#pragma once

#include <memory>
#include <optional>

#include "firmware/options.h"
#include "firmware/telemetry.h"
#include "hal/open_device.h"
#include "model/scene.h"
#include "model/tissue.h"

namespace tact::firmware {

/// What is known of the run before it starts.
struct RunSetup {
  const model::Scene& scene;
  const Options& options;
  const model::Tissue& tissue;
  hal::Device& device;
  model::Limits limits;  // of scene and device together
  std::int64_t period_ns = 0;
  double force_share = 1.0;
  const Gate& gate;
  bool non_rt = false;
};

struct Outlets {
  Sinks sinks;
  std::unique_ptr<hal::HandSocket> hand;  // of a simulated device
  std::string no_black_box;               // why there is none although nobody declined it
};

/// What the command line asks for; the rest stays empty. A black box whose usual folder cannot be
/// written is done without; one that was asked for is an error.
model::Result<Outlets> open_outlets(const RunSetup& run);

}  // namespace tact::firmware
