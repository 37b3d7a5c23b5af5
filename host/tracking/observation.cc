#include "host/tracking/observation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace tact::host {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 32;
// A microsecond still counts in a double, and no sum of two times overflows.
constexpr double kLatest_s = 1e9;
constexpr double kFarthest_px = 1e6;

/// A finite number no larger than `most`.
bool read(const json& object, const char* key, double most, double& out) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return false;
  out = found->get<double>();
  return std::abs(out) <= most;  // false for NaN
}

bool read_name(const json& object, const char* key, std::string& out) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return false;
  out = found->get<std::string>();
  return is_tracking_name(out);
}

bool read_marker(const json& point, SeenMarker& out) {
  if (!point.is_array() || point.size() != 3 || !point[0].is_number_unsigned()) return false;
  const auto id = point[0].get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return false;
  out.id = static_cast<std::uint32_t>(id);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!point[axis + 1].is_number()) return false;
    const double value_px = point[axis + 1].get<double>();
    if (!(std::abs(value_px) <= kFarthest_px)) return false;
    out.pixel_px[static_cast<Eigen::Index>(axis)] = value_px;
  }
  return true;
}

std::string read_points(const json& object, std::vector<SeenMarker>& out) {
  const auto found = object.find("points");
  if (found == object.end() || !found->is_array())
    return "points is no list; write [[id, u, v], ...]";
  if (found->size() > kMaxMarkers) {
    return fmt::format("it has {} points; send at most {}", found->size(), kMaxMarkers);
  }
  for (const json& point : *found) {
    SeenMarker marker;
    if (!read_marker(point, marker)) {
      return fmt::format(
          "point {} is not [id, u, v]; id is a whole number >= 0, u and v are finite", out.size());
    }
    const bool twice =
        std::ranges::any_of(out, [&](const SeenMarker& m) { return m.id == marker.id; });
    if (twice) return fmt::format("marker {} is there twice; send each marker once", marker.id);
    out.push_back(marker);
  }
  return {};
}

}  // namespace

bool is_tracking_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, is_plain);
}

std::string parse_observation(std::string_view bytes, Observation& out) {
  if (bytes.size() > kMaxObservationBytes) {
    return fmt::format("it has {} bytes; an observation has at most {}", bytes.size(),
                       kMaxObservationBytes);
  }
  const json object = json::parse(bytes, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return "it is no JSON object; send {\"time_s\": .., \"points\": ..}";
  Observation seen;
  if (!read(object, "time_s", kLatest_s, seen.time_s)) {
    return "time_s is no time; write seconds of the tracker's clock, at most 1e9";
  }
  const auto sequence = object.find("sequence");
  if (sequence == object.end() || !sequence->is_number_unsigned()) {
    return "sequence is no number; count the camera's pictures from 0";
  }
  seen.sequence = sequence->get<std::uint64_t>();
  for (auto [key, name] : {std::pair{"camera", &seen.camera}, std::pair{"body", &seen.body}}) {
    if (!read_name(object, key, *name)) {
      return fmt::format("{} is no name; write 1 to 32 letters, digits, _ or -", key);
    }
  }
  if (std::string wrong = read_points(object, seen.points); !wrong.empty()) return wrong;
  out = std::move(seen);
  return {};
}

}  // namespace tact::host
