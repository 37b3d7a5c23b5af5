// SPDX-License-Identifier: Apache-2.0
// operator_record.h - the tracked operator in a recording: a record behind each frame at which a
// tracker was connected.
//
// For each body the raw pose as solved and the pose that was shown, both in the device's frame W.
// Then the figure as it was shown: its position and its bound bones have a history from before the
// recording, so a figure posed again from the bodies alone would differ. operator_record.cc says
// what each field is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/protocol/run_file.h"
#include "host/figure/figure.h"

namespace tact::host::record {

/// The name of a number from a file, which may be no BodyState.
const char* body_state(std::uint64_t number);

struct BodyRecord {
  double raw_position_m[3] = {};
  double raw_rotation_wxyz[4] = {1.0, 0.0, 0.0, 0.0};
  float shown_position_m[3] = {};
  float shown_rotation_wxyz[4] = {1.0f, 0.0f, 0.0f, 0.0f};
  float rms_px = 0.0f;
  float age_s = 0.0f;
  tracking::BodyState state{};
  tracking::TrackingTrouble trouble{};

  static firmware::protocol::FieldTable fields();
};

/// FigurePose without its trouble and words, which follow from it and the bodies.
struct FigureRecord {
  double height_m = 0.0;  // 0: no figure was shown
  float joint_m[figure::kFigureJoints][3] = {};
  float head_wxyz[4] = {1.0f, 0.0f, 0.0f, 0.0f};
  float grip_m[3] = {};
  float error_m = 0.0f;
  std::uint16_t sweeps = 0, updates = 0;
  bool reached = false, out_of_reach = false, full_chain = false;
  bool left_leg_reached = false, right_leg_reached = false;
  bool shoulder_too_far = false, left_hand_missed = false;

  static firmware::protocol::FieldTable fields();
};

struct OperatorRecord {
  static constexpr auto kKind = firmware::protocol::ChunkKind::kOperator;
  static constexpr const char* kName = "operator";

  double time_s = 0.0;
  BodyRecord body[tracking::kBodyRoles] = {};  // by BodyRole
  FigureRecord figure = {};

  static firmware::protocol::FieldTable fields();
};

/// The chunk behind a frame; `figure` may be null.
std::string operator_chunk(const tracking::TrackedOperator& tracked,
                           const figure::FigurePose* figure = nullptr);
/// Nothing if a value is invalid.
std::optional<tracking::TrackedOperator> operator_of(const OperatorRecord& record);
/// The figure that was shown with these bodies, to a relative 1e-6; nothing if there was none, or a
/// number is not finite.
std::optional<figure::FigurePose> figure_of(const OperatorRecord& record,
                                            const tracking::TrackedOperator& bodies);

}  // namespace tact::host::record
