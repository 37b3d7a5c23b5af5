// SPDX-License-Identifier: Apache-2.0
// Bytes of a tracker are an observation that keeps its promises, or one message.
#include <cmath>
#include <string_view>

#include "host/tracking/observation.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tact;
  using fuzz::require;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const model::Result<host::tracking::Observation> read = host::tracking::parse_observation(bytes);
  if (!read) {
    const std::string& message = read.error().message;
    require(!message.empty() && message.find('\n') == message.npos);
    return 0;
  }
  const host::tracking::Observation& seen = *read;
  require(size <= host::tracking::kMaxObservationBytes && std::isfinite(seen.time_s));
  require(host::tracking::is_tracking_name(seen.camera) &&
          host::tracking::is_tracking_name(seen.body));
  require(seen.points.size() <= host::tracking::kMaxMarkers);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    require(seen.points[i].pixel_px.allFinite());
    for (std::size_t k = 0; k < i; ++k) require(seen.points[i].id != seen.points[k].id);
  }
  return 0;
}
