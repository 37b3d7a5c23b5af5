// operator_record.h - the tracked operator in a recording: one record of fixed size behind each
// frame of a recording of version 4 (firmware/recording_format.h).
//
// Of each body the raw pose, as solved, and the one that was shown, both in the device's frame W.
// Little-endian, CRC-32 as the frames have; a damaged record costs this frame's operator only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "host/tracking/tracked_operator.h"

namespace tact::host {

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

struct OperatorRecord {
  double time_s = 0.0;
  BodyRecord body[kBodyRoles] = {};  // by BodyRole
  std::uint32_t crc = 0;             // of all before it
  std::uint32_t pad = 0;
};

static_assert(std::is_trivially_copyable_v<OperatorRecord>);
static_assert(sizeof(BodyRecord) == 7 * 8 + 9 * 4 + 4 && sizeof(BodyRecord) % 8 == 0);
static_assert(sizeof(OperatorRecord) == 16 + kBodyRoles * sizeof(BodyRecord));

/// The bytes behind one frame.
std::string operator_record(const TrackedOperator& tracked);
/// Nothing if the checksum differs or a number makes no sense.
std::optional<TrackedOperator> operator_of(const OperatorRecord& record);

}  // namespace tact::host
