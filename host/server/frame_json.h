// SPDX-License-Identifier: Apache-2.0
// frame_json.h - telemetry as JSON text for the page.
//
// The JSON of a frame that passes check_frame has at most kMaxFrameJsonBytes: lengths and forces
// have four significant digits, the tool's position six, and only sites in contact are listed. A
// number that is not finite becomes null, because JSON has no NaN. A law without profiles has
// displaced vertices instead, in base64: n vertex numbers (uint32), n displacements (3 int16, um).
#pragma once

#include <string>

#include "host/record/telemetry_check.h"

namespace tact::host::server {

inline constexpr std::size_t kMaxFrameJsonBytes = 4352;

/// {"kind":"frame","tick":..,"time_s":..,"tool_m":[x,y,z],...,"sites":[{"site":0,...,"u_m":[..]}]}
std::string frame_json(const record::Frame& frame, const record::Hello& hello);

/// Constant while tactd runs: names, counts, limits, probe spheres.
std::string scene_json(const record::Hello& hello);

}  // namespace tact::host::server
