// SPDX-License-Identifier: Apache-2.0
// loop_parts.h - everything that a tick touches, opened and checked in the order in which it comes
// to life. Set-up code: `tactd`, `tact-jitter` and `tact-limits` run the same loop, in a thread of
// thread_costs.h.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "firmware/admission/stiffness_check.h"
#include "firmware/admission/tick_budget.h"
#include "firmware/gate/gate.h"
#include "firmware/guardian/guardian.h"
#include "firmware/loop/controller.h"
#include "firmware/loop/ring.h"
#include "firmware/pc/rt_setup.h"
#include "hal/registry/open_device.h"
#include "hal/safety_lines.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::run {

struct PartsSetup {
  bool simulated_time = false;  // waits for any law, so no law is too slow
  bool non_rt = false;          // caps the force; simulated time is never late
  pc::RtSettings rt;

  double force_share() const { return non_rt ? gate::kNonRtForceShare : 1.0; }
};

struct LoopParts {
  std::unique_ptr<model::scene::Tissue> tissue;
  std::unique_ptr<hal::SafetyLines> lines;
  std::unique_ptr<guardian::Guardian>
      guardian;                      // outlives the device; null: it has no shutdown frames
  hal::registry::OpenDevice device;  // off when the parts go, whatever ended them
  admission::StiffnessMargin stiffness;
  std::optional<admission::TimeMargin> time;
  std::optional<admission::PressCheck> presses;
  model::Limits limits;         // of scene and device together
  std::string limits_checksum;  // in use, the PC's share counted
  std::unique_ptr<loop::Controller> controller;
  std::unique_ptr<loop::TickRing> ring;
};

/// Opens the device of the scene and checks that the law may be felt on it.
model::Result<LoopParts> open_loop_parts(const model::scene::Scene& scene, const PartsSetup& setup);

/// The process that zeroes this device if its program dies; null: the device has no shutdown
/// frames.
model::Result<std::unique_ptr<guardian::Guardian>> start_guardian(hal::Device& device,
                                                                  const pc::RtSettings& rt);

}  // namespace tact::firmware::run
