// SPDX-License-Identifier: Apache-2.0
// observation.h - one observation of one body by one camera, as a tracker sends it: one JSON object
// per UDP datagram or line of a file.
//
//     {"time_s": 12.0333, "sequence": 361, "camera": "front", "body": "head",
//      "points": [[id, u, v], ...]}
//
//     time_s    of the tracker's own monotonic clock, s      sequence  counts per camera
//     camera, body  names of the tracking description: 1 to 32 letters, digits, _ or -
//     id        of a marker of the body      u, v  px, or tangents of a sweep tracker
//
// Any bytes give an observation or one error message. Other keys are ignored.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/result.h"

namespace tact::host::tracking {

inline constexpr std::size_t kMaxMarkers = 64;
inline constexpr std::size_t kMaxObservationBytes = 8192;

struct SeenMarker {
  std::uint32_t id = 0;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();  // or tangents

  friend bool operator==(const SeenMarker&, const SeenMarker&) = default;
};

struct Observation {
  double time_s = 0.0;
  std::uint64_t sequence = 0;
  std::string camera, body;
  std::vector<SeenMarker> points;  // at most kMaxMarkers, with different ids and finite numbers

  friend bool operator==(const Observation&, const Observation&) = default;
};

/// The error states what is wrong with the bytes, and what is expected.
model::Result<Observation> parse_observation(std::string_view bytes);

/// A name of a camera or a body: 1 to 32 letters, digits, _ or -.
bool is_tracking_name(std::string_view name);

}  // namespace tact::host::tracking
