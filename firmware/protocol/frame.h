// SPDX-License-Identifier: Apache-2.0
// frame.h - what a viewer draws of one moment: the newest tick, and the extremes since the frame
// before. frame.cc says what each field is.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "firmware/loop/state.h"
#include "firmware/protocol/chunks.h"
#include "firmware/protocol/record_fields.h"
#include "firmware/protocol/record_parts.h"

namespace tact::firmware::protocol {

inline constexpr std::size_t kMaxProfilePoints = 32;   // of one contact
inline constexpr std::size_t kMaxPatchVertices = 180;  // in one frame
inline constexpr std::size_t kMaxCutsReported = 32;    // in one frame
inline constexpr std::size_t kMaxPieces = 4;           // pieces of the organ's mesh with a colour

struct FrameContact {
  float surface_point_m[3] = {};
  float normal[3] = {};
  float shift_m[3] = {};
  float depth_m = 0.0f;
  float profile_m[kMaxProfilePoints] = {};
  float tilt[3] = {};
  ContactState state = ContactState::kFree;

  static FieldTable fields();
};

/// Replaces the profiles of a mass-spring law. Each frame reports a window of the list of cuts; the
/// window advances from frame to frame.
struct FramePatch {
  std::uint32_t vertex_count = 0;
  std::uint32_t cut_total = 0, cut_first = 0;
  std::uint32_t cut_count = 0;
  std::uint32_t vertex[kMaxPatchVertices] = {};
  std::uint32_t cut_triangle[kMaxCutsReported] = {};
  std::int16_t displacement_um[kMaxPatchVertices][3] = {};

  static FieldTable fields();
};

/// Counts of all ticks whose records have reached telemetry, by a duration of the tick.
struct FrameDurations {
  /// Upper bounds, us, of all buckets but the last; frame.cc has them as names of the components.
  static constexpr std::array kBound_us{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 5000};
  std::uint64_t ticks[kBound_us.size() + 1] = {};
  std::uint64_t sum_ns = 0;

  void add(std::int64_t duration_ns);
  static FieldTable fields();
};

/// Newest one of tactctl.
struct FrameEvent {
  std::uint8_t number = 0;
  std::int64_t due_ns = 0;

  static FieldTable fields();
};

struct Frame {
  static constexpr ChunkKind kKind = ChunkKind::kFrame;
  static constexpr const char* kName = "frame";

  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::int64_t due_ns = 0;
  UtcOffset utc;
  std::uint64_t late_ticks = 0, skipped_ticks = 0, dropped_records = 0;
  float tool_position_m[3] = {};
  float tool_orientation[4] = {1, 0, 0, 0};
  float tool_velocity_mps[3] = {};
  float grip_ratio = 0.0f;
  float force_N[3] = {};
  float torque_Nm[3] = {};
  float wanted_force_N[3] = {};
  float worst_margin_us = 0.0f;
  float median_tick_us = 0.0f;
  float peak_force_N = 0.0f;
  float rms_force_N = 0.0f;
  float given_energy_J = 0.0f;
  float grip_force_N = 0.0f;
  std::uint16_t fault = 0;
  std::uint16_t limit = 0;
  loop::State state = loop::State::kOff;
  bool non_rt = false;
  std::uint32_t contact_losses = 0;
  float temperature_C = std::numeric_limits<float>::quiet_NaN();
  FrameDurations wake, duration;
  FrameEvent event;
  FrameContact contact[kMaxContacts] = {};
  FramePatch patch;

  /// Fields of a run whose tool has that many spheres: files and frames hold those contacts alone.
  static FieldTable fields(std::size_t spheres = kMaxContacts);
};

}  // namespace tact::firmware::protocol
