// SPDX-License-Identifier: Apache-2.0
// controller.h - the phases detect, render and limit of a tick, without device and clock.
//
// The force depends on TickInput and on the contact in use, so a replay of a recorded run gives the
// same bits (replay.h): TickInput::variant names the contact. The loop (rt_loop.h) calls the three
// phases and measures their durations.
#pragma once

#include <optional>

#include "firmware/gate/gate.h"
#include "firmware/gate/grip_gate.h"
#include "firmware/loop/clutch.h"
#include "firmware/loop/overrun_counter.h"
#include "firmware/loop/supervisor.h"
#include "hal/device.h"
#include "hal/threads/latest_slot.h"
#include "model/contact/contact.h"

namespace tact::firmware::loop {

/// All inputs of a tick.
struct TickInput {
  hal::Sample sample;
  Fault device_fault = Fault::kNone;
  Commands commands;
  bool ready = true;  // the lines permit power and the device's motors are on
  ClutchState clutch = ClutchState::kCoupled;
  std::uint32_t skipped_periods = 0;  // between the previous tick and this one
  std::uint32_t clutches = 0;         // how often the clutch has opened so far
  std::uint32_t variant = 0;  // of the law's numbers, counted since the start; 0: the scene's own
  model::Vec3 clutch_shift_m{};  // of the tool from the handle, in W
};

/// All outputs of a tick.
struct TickOutput {
  model::Wrench wanted;   // from contact and law
  model::Wrench written;  // after the gate
  State state = State::kOff;
  Fault limit = Fault::kNone;
  Fault fault = Fault::kNone;        // latched
  double given_energy_J = 0.0;       // energy given minus taken by the device since arming
  double rms_force_N = 0.0;          // written, over limits.thermal_time_s
  std::uint64_t contact_losses = 0;  // so far; by motion above the speed limit between two samples
  double wanted_grip_N = 0.0, written_grip_N = 0.0;  // on the fingers, opening positive
};

using ShapeSlot = hal::threads::LatestSlot<model::contact::PatchShape>;

class Controller {
 public:
  /// `hard_real_time` sets the limits of the OverrunCounter.
  Controller(const model::contact::ContactScene& scene, const gate::Gate& gate, bool hard_real_time,
             const std::optional<gate::GripGate>& grip_gate = std::nullopt);

  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// True while the tool is out of contact, so that another tissue changes no force.
  bool is_clear() const RT_SAFE { return contact_->is_clear(); }
  /// Uses this contact from now on; it outlives the controller or the next call.
  void use(model::contact::Contact& contact) RT_SAFE {
    contact.continue_from(*contact_);
    contact_ = &contact;
  }
  void detect_contact(const TickInput& input) RT_SAFE;
  void render_force(const TickInput& input) RT_SAFE;
  TickOutput limit(const TickInput& input) RT_SAFE;

  /// Runs the three phases.
  TickOutput tick(const TickInput& input) RT_SAFE {
    detect_contact(input);
    render_force(input);
    return limit(input);
  }

  /// Writes the shape of a stepped law to the slot; does nothing for laws with a profile.
  void publish_shape() RT_SAFE;
  ShapeSlot& shapes() { return shapes_; }

  std::span<const model::contact::SphereContact> contacts() const RT_SAFE {
    return contact_->contacts();
  }
  /// A sphere is inside the organ in this tick.
  bool is_inside() const RT_SAFE { return rendered_.is_inside; }
  const gate::Gate& gate() const RT_SAFE { return gate_; }
  /// Output of the last tick; to be read after the loop.
  const TickOutput& newest() const { return newest_; }

 private:
  Fault find_fault(const TickInput& input, bool finite, bool too_late) const RT_SAFE;
  Fault find_limit(Fault acting, bool is_coupled) const RT_SAFE;
  gate::LimitedGrip limit_grip(const TickInput& input) RT_SAFE;
  double reach_m(std::uint64_t periods, std::int64_t stamp_ns) const RT_SAFE;

  model::contact::Contact own_contact_;               // of the scene's own numbers
  model::contact::Contact* contact_ = &own_contact_;  // in use
  gate::Gate gate_;
  std::optional<gate::GripGate> grip_gate_;  // if the gripper has a motor
  OverrunCounter overruns_;
  Supervisor supervisor_;
  model::contact::ContactResponse rendered_;  // of this tick
  double jaw_force_N_ = 0.0;                  // of this tick
  Fault acting_ = Fault::kNone;               // of the gate in the last tick
  bool was_open_ = false;                     // clutch in the last tick
  TickOutput newest_;
  model::contact::PatchShape shape_;
  ShapeSlot shapes_;
  double fastest_mps_;         // speed limit of a sphere
  bool seen_ = false;          // a fresh sample has come
  std::uint64_t unseen_ = 0;   // periods in a row without a sample
  std::int64_t stamp_ns_ = 0;  // of the last sample
  std::uint64_t contact_losses_ = 0;
};

}  // namespace tact::firmware::loop
