// Bytes of a tracker are an observation that keeps its promises, or one sentence.
#include <cmath>
#include <string_view>

#include "host/tracking/observation.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tact;
  using fuzz::require;
  host::Observation seen;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string wrong = host::parse_observation(bytes, seen);
  if (!wrong.empty()) {
    require(wrong.find('\n') == wrong.npos && seen == host::Observation{});
    return 0;
  }
  require(size <= host::kMaxObservationBytes && std::isfinite(seen.time_s));
  require(host::is_tracking_name(seen.camera) && host::is_tracking_name(seen.body));
  require(seen.points.size() <= host::kMaxMarkers);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    require(seen.points[i].pixel_px.allFinite());
    for (std::size_t k = 0; k < i; ++k) require(seen.points[i].id != seen.points[k].id);
  }
  return 0;
}
