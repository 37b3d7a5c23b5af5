// telemetry_setup.h - everything that leaves a run: viewer socket, hand socket, tick log.
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
  std::optional<TelemetrySocket> socket;
  std::unique_ptr<hal::HandSocket> hand;  // of a simulated device
  std::optional<TickLogWriter> log;
};

/// What the command line asks for; the rest stays empty.
model::Result<Outlets> open_outlets(const RunSetup& run);

}  // namespace tact::firmware
