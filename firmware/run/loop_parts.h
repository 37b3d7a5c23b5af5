// SPDX-License-Identifier: Apache-2.0
// loop_parts.h - opens and checks all objects that a tick uses, in the order of their dependences.
// Set-up code: `tactd`, `tact-jitter` and `tact-limits` run the same loop, in a thread of
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
  bool simulated_time = false;  // time waits for the law, so no law is too slow
  bool non_rt = false;          // caps the force; not set for simulated time
  pc::RtSettings rt;

  double force_share() const { return non_rt ? gate::kNonRtForceShare : 1.0; }
};

struct LoopParts {
  std::unique_ptr<model::scene::Tissue> tissue;
  std::unique_ptr<hal::SafetyLines> lines;
  std::unique_ptr<guardian::Guardian> guardian;  // outlives the device; null: no shutdown frames
  hal::registry::OpenDevice device;              // its destructor switches the device off
  admission::StiffnessMargin stiffness;
  std::optional<admission::TimeMargin> time;
  std::optional<admission::PressCheck> presses;
  model::Limits limits;         // of scene and device together
  std::string limits_checksum;  // of the limits in use, with the force share of this PC
  std::unique_ptr<loop::Controller> controller;
  std::unique_ptr<loop::TickRing> ring;
};

/// Opens the device of the scene and checks that the law may be rendered on it.
model::Result<LoopParts> open_loop_parts(const model::scene::Scene& scene, const PartsSetup& setup);

/// Starts the process that zeroes this device if its program dies; null: the device has no shutdown
/// frames.
model::Result<std::unique_ptr<guardian::Guardian>> start_guardian(
    hal::Device& device, const guardian::GuardianSettings&);

}  // namespace tact::firmware::run
