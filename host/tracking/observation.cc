// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/observation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "model/io/json.h"

namespace tact::host::tracking {
namespace {

using model::Error;
using model::Result;
using nlohmann::json;

constexpr std::size_t kLongestName = 32;
// Up to this a double resolves a microsecond, and sums of two times do not overflow.
constexpr double kLatest_s = 1e9;
// Chosen: larger than any image, and its square is exact.
constexpr double kFarthest_px = 1e6;

/// A finite number no larger than `most`.
std::optional<double> read(const json& object, const char* key, double most) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const auto value = found->get<double>();
  if (!(std::abs(value) <= most)) return std::nullopt;  // NaN, too
  return value;
}

std::optional<std::string> read_name(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return std::nullopt;
  auto name = found->get<std::string>();
  if (!is_tracking_name(name)) return std::nullopt;
  return name;
}

std::optional<SeenMarker> read_marker(const json& point) {
  if (!point.is_array() || point.size() != 3 || !point[0].is_number_unsigned()) return std::nullopt;
  const auto id = point[0].get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  SeenMarker marker{.id = static_cast<std::uint32_t>(id)};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!point[axis + 1].is_number()) return std::nullopt;
    const double value_px = point[axis + 1].get<double>();
    // Written so that a NaN is refused.
    if (!(std::abs(value_px) <= kFarthest_px)) return std::nullopt;
    marker.pixel_px[static_cast<Eigen::Index>(axis)] = value_px;
  }
  return marker;
}

Result<std::vector<SeenMarker>> read_points(const json& object) {
  const auto found = object.find("points");
  if (found == object.end() || !found->is_array())
    return Error{"points is no list; write [[id, u, v], ...]"};
  if (found->size() > kMaxMarkers)
    return Error{fmt::format("it has {} points; send at most {}", found->size(), kMaxMarkers)};
  std::vector<SeenMarker> points;
  for (const json& point : *found) {
    const std::optional<SeenMarker> marker = read_marker(point);
    if (!marker) {
      return Error{
          fmt::format("point {} is not [id, u, v]; id is a whole number >= 0, u and v are finite",
                      points.size())};
    }
    // A marker with two positions: neither is reliable, and both would distort the pose.
    const bool twice =
        std::ranges::any_of(points, [&](const SeenMarker& m) { return m.id == marker->id; });
    if (twice)
      return Error{fmt::format("marker {} is there twice; send each marker once", marker->id)};
    points.push_back(*marker);
  }
  return points;
}

}  // namespace

bool is_tracking_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, is_plain);
}

Result<Observation> parse_observation(std::string_view bytes) {
  // Before parsing, because the parser accepts any length.
  if (bytes.size() > kMaxObservationBytes) {
    return Error{fmt::format("it has {} bytes; an observation has at most {}", bytes.size(),
                             kMaxObservationBytes)};
  }
  const auto parsed = model::io::parse_json(bytes, "observation");
  if (!parsed || !parsed->is_object())
    return Error{"it is no JSON object; send {\"time_s\": .., \"points\": ..}"};
  const json& object = *parsed;
  Observation seen;
  const std::optional<double> time_s = read(object, "time_s", kLatest_s);
  if (!time_s) return Error{"time_s is no time; write seconds of the tracker's clock, at most 1e9"};
  seen.time_s = *time_s;
  const auto sequence = object.find("sequence");
  if (sequence == object.end() || !sequence->is_number_unsigned())
    return Error{"sequence is no number; count the camera's pictures from 0"};
  seen.sequence = sequence->get<std::uint64_t>();
  for (auto [key, name] : {std::pair{"camera", &seen.camera}, std::pair{"body", &seen.body}}) {
    std::optional<std::string> given = read_name(object, key);
    if (!given)
      return Error{fmt::format("{} is no name; write 1 to 32 letters, digits, _ or -", key)};
    *name = std::move(*given);
  }
  Result<std::vector<SeenMarker>> points = read_points(object);
  if (!points) return points.error();
  seen.points = std::move(*points);
  return seen;
}

}  // namespace tact::host::tracking
