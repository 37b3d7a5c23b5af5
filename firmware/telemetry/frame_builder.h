// SPDX-License-Identifier: Apache-2.0
// frame_builder.h - turns a scene into the head of a run, and tick records into frames.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "firmware/protocol/frame.h"
#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_header.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::telemetry {

using protocol::Frame;
using protocol::FrameContact;
using protocol::FramePatch;
using protocol::LoggedTick;
using protocol::RunHeader;

/// What of the head follows from the scene. Device, limits, PC and date are the caller's.
RunHeader header_of(const model::scene::Scene& scene, const model::scene::Tissue& tissue);
/// Organ vertices (3 float each, W, m), organ triangles (3 uint32 each), the same for the tool mesh
/// (tool frame, m), then, if the scene has them, the colours of the organ's vertices (3 uint8 each,
/// sRGB).
std::vector<std::byte> mesh_bytes(const model::scene::Scene& scene);
/// A sealed memory file.
model::Result<int> make_memory_file(const std::string& bytes);

/// One tick as a frame: what the tick does not hold comes from `previous`, the frame before it.
Frame frame_of_tick(const Frame& previous, const LoggedTick& tick, std::int64_t time_ns);

/// Collects records; a frame has the newest values, and the extremes since the last frame.
class FrameBuilder {
 public:
  /// `indentations` and `shapes` must outlive the builder, which solves profiles outside the loop.
  FrameBuilder(const model::contact::IndentationView& indentations, loop::ShapeSlot& shapes,
               bool non_rt, const protocol::UtcOffset& utc = {})
      : indentations_(&indentations), shapes_(shapes), non_rt_(non_rt), utc_(utc) {}

  /// The tissue of the records from now on.
  void use(const model::contact::IndentationView& indentations) { indentations_ = &indentations; }
  void add(const loop::TickRecord& record);
  /// Applies to the records from now on.
  void set_utc(const protocol::UtcOffset& utc) { utc_ = utc; }
  LoggedTick log(const loop::TickRecord& record) const {
    return LoggedTick::of(record, non_rt_, utc_);
  }
  bool has_news() const { return !tick_us_.empty(); }
  Frame take(std::uint64_t dropped_records);

 private:
  void add_contact(const model::contact::SphereContact& sphere_contact,
                   FrameContact& contact) const;
  void add_patch(FramePatch& patch);

  const model::contact::IndentationView* indentations_;
  loop::ShapeSlot& shapes_;
  model::contact::PatchShape shape_;
  bool non_rt_;
  protocol::UtcOffset utc_;
  loop::TickRecord newest_;
  std::int64_t first_due_ns_ = -1;
  std::vector<float> tick_us_;  // since the last frame
  protocol::FrameEvent event_;
  protocol::FrameDurations wake_, duration_;
  float worst_margin_us_ = 0.0f;
  float peak_force_N_ = 0.0f;
  float given_energy_J_ = 0.0f;
  model::Fault limit_ = model::Fault::kNone;
};

}  // namespace tact::firmware::telemetry
