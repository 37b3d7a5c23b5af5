// SPDX-License-Identifier: Apache-2.0
// operator_record.h - the tracked operator in a recording: one record of fixed size after each
// frame of a recording of version 9 (firmware/telemetry/recording_format.h).
//
// For each body the raw pose as solved and the pose that was shown, both in the device's frame W.
// Then the figure as it was shown: its position and its bound bones have a history from before the
// recording, so a figure posed again from the bodies alone would differ. Little-endian, CRC-32 as
// for frames; a damaged record loses only the operator of this frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "host/figure/figure.h"

namespace tact::host::record {

struct BodyRecord {
  double raw_position_m[3] = {};
  double raw_rotation_wxyz[4] = {1.0, 0.0, 0.0, 0.0};
  float shown_position_m[3] = {};
  float shown_rotation_wxyz[4] = {1.0f, 0.0f, 0.0f, 0.0f};
  float rms_px = 0.0f;
  float age_s = 0.0f;
  std::uint8_t state = 0, trouble = 0;  // BodyState, TrackingTrouble
  std::uint8_t pad[2] = {};
};

enum FigureFlag : std::uint8_t {
  kLeftLegReached = 1,
  kRightLegReached = 2,
  kShoulderTooFar = 4,
  kLeftHandMissed = 8,
};

/// FigurePose without its trouble and words, which follow from it and the bodies.
struct FigureRecord {
  double height_m = 0.0;  // 0: no figure was shown
  float joint_m[figure::kFigureJoints][3] = {};
  float head_wxyz[4] = {1.0f, 0.0f, 0.0f, 0.0f};
  float grip_m[3] = {};
  float error_m = 0.0f;
  std::uint16_t sweeps = 0, updates = 0;
  std::uint8_t reached = 0, out_of_reach = 0, full_chain = 0;
  std::uint8_t flags = 0;  // FigureFlag
  std::uint8_t pad[4] = {};
};

struct OperatorRecord {
  double time_s = 0.0;
  BodyRecord body[tracking::kBodyRoles] = {};  // by BodyRole
  FigureRecord figure = {};
  std::uint32_t crc = 0;  // of all bytes before it
  std::uint32_t pad = 0;
};

static_assert(std::is_trivially_copyable_v<OperatorRecord>);
static_assert(sizeof(BodyRecord) == 7 * 8 + 9 * 4 + 4 && sizeof(BodyRecord) % 8 == 0);
static_assert(sizeof(FigureRecord) == 8 + (3 * figure::kFigureJoints + 8) * 4 + 12);
static_assert(sizeof(FigureRecord) % 8 == 0);
static_assert(sizeof(OperatorRecord) == 1496);  // as host/PROTOCOL.md has it

/// The bytes after one frame; `figure` may be null.
std::string operator_record(const tracking::TrackedOperator& tracked,
                            const figure::FigurePose* figure = nullptr);
/// Nothing if the checksum differs or a value is invalid.
std::optional<tracking::TrackedOperator> operator_of(const OperatorRecord& record);
/// The figure that was shown with these bodies, to a relative 1e-6; nothing if there was none, or a
/// number is not finite.
std::optional<figure::FigurePose> figure_of(const OperatorRecord& record,
                                            const tracking::TrackedOperator& bodies);

}  // namespace tact::host::record
