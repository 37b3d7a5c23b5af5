// SPDX-License-Identifier: Apache-2.0
// telemetry_frame.h - turns tick records into messages for viewers: one Hello, then Frames.
#pragma once

#include <vector>

#include "firmware/telemetry/telemetry_record.h"
#include "firmware/telemetry/tick_log.h"
#include "hal/device.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::telemetry {

struct HelloFacts {
  hal::DeviceInfo device;
  double force_limit_N = 0.0;
  double torque_limit_Nm = 0.0;
  double continuous_force_N = 0.0;
  double energy_budget_J = 0.0;
  std::string limits_checksum{};
  bool non_rt = false;
  bool cannot_grip = false;
  std::string hand_socket{};  // empty: the device is not simulated
};

Hello make_hello(const model::scene::Scene& scene, const model::scene::Tissue& tissue,
                 const HelloFacts& facts);
/// A sealed memory file of the meshes, laid out as telemetry_record.h says.
model::Result<int> make_mesh_file(const model::scene::Scene& scene);

/// One tick as a frame: what the tick does not hold comes from `picture`, the frame before it.
Frame frame_of_tick(const Frame& picture, const LoggedTick& tick, std::int64_t time_ns);

/// Collects records; a frame has the newest values, and the extremes since the last frame.
class FrameBuilder {
 public:
  /// `indentations` and `shapes` must outlive the builder, which solves profiles outside the loop.
  FrameBuilder(const model::contact::IndentationView& indentations, loop::ShapeSlot& shapes,
               bool non_rt)
      : indentations_(indentations), shapes_(shapes), non_rt_(non_rt) {}

  void add(const loop::TickRecord& record);
  bool has_news() const { return !tick_us_.empty(); }
  Frame take(std::uint64_t dropped_records);

 private:
  void add_site(const model::contact::SphereContact& sphere_contact, FrameSite& site) const;
  void add_patch(FramePatch& patch);

  const model::contact::IndentationView& indentations_;
  loop::ShapeSlot& shapes_;
  model::contact::PatchShape shape_;
  bool non_rt_;
  loop::TickRecord newest_;
  std::int64_t first_due_ns_ = -1;
  std::vector<float> tick_us_;  // since the last frame
  float worst_margin_us_ = 0.0f;
  float peak_force_N_ = 0.0f;
  float given_energy_J_ = 0.0f;
  model::Fault limit_ = model::Fault::kNone;
};

}  // namespace tact::firmware::telemetry
