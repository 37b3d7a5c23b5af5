// SPDX-License-Identifier: Apache-2.0
// frame_json.h - telemetry as JSON text for the page.
//
// The keys are the fields' names (firmware/protocol/frame.cc). The JSON of a frame that passes
// check_frame has at most kMaxFrameJsonBytes: numbers have six digits, and only spheres in contact
// are listed. A number that is not finite becomes null, because JSON has no NaN. A law
// without profiles has displaced vertices instead, in base64: n vertex numbers (uint32), n
// displacements (3 int16, um).
#pragma once

#include <string>

#include "host/record/telemetry_check.h"

namespace tact::host::server {

inline constexpr std::size_t kMaxFrameJsonBytes = 11'936;  // 16 spheres pressing

/// {"kind":"frame","tick":..,"force_N":[x,y,z],...,"contacts":[{"contact":0,"depth_m":..,...}]}
std::string frame_json(const record::Frame& frame, const record::RunHeader& header);

/// Constant while tactd runs: names, counts, limits, probe spheres.
std::string scene_json(const record::RunHeader& header);

}  // namespace tact::host::server
