// SPDX-License-Identifier: Apache-2.0
#include "host/server/replay_request.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::host::server {
namespace {

constexpr double kLongest_s = 1e7;              // longer than any recording
constexpr double kFastest_ratio = 20;           // the slowest is its inverse
constexpr std::int64_t kMaxFrames = 1'000'000;  // of one step; fits an int

bool take(const nlohmann::json& value, std::optional<bool>& into) {
  if (!value.is_boolean()) return false;
  into = value.get<bool>();
  return true;
}

bool take(const nlohmann::json& value, double low, double high, std::optional<double>& into) {
  if (!value.is_number()) return false;
  into = value.get<double>();
  return *into >= low && *into <= high;  // false for a NaN or an infinity
}

bool take(const nlohmann::json& value, std::optional<int>& into) {
  if (!value.is_number_integer()) return false;
  // By double: a 64-bit integer would be truncated to int silently.
  const double frames = value.get<double>();
  if (std::abs(frames) > static_cast<double>(kMaxFrames)) return false;
  into = static_cast<int>(frames);
  return true;
}

}  // namespace

nlohmann::json object_in(const std::string& text, const char* key) {
  const auto message = model::io::parse_json(text, "request");
  if (!message || !message->is_object()) return {};
  const auto found = message->find(key);
  return found != message->end() && found->is_object() ? *found : nlohmann::json();
}

std::optional<ReplayRequest> parse_replay(const std::string& text) {
  const nlohmann::json replay = object_in(text, "replay");
  if (replay.is_null()) return std::nullopt;
  ReplayRequest request;
  for (const auto& [key, value] : replay.items()) {
    const bool good = key == "playing"       ? take(value, request.playing)
                      : key == "at_s"        ? take(value, 0.0, kLongest_s, request.at_s)
                      : key == "step_frames" ? take(value, request.step_frames)
                      : key == "speed_ratio"
                          ? take(value, 1.0 / kFastest_ratio, kFastest_ratio, request.speed_ratio)
                      : key == "repeats" ? take(value, request.repeats)
                                         : false;
    // One wrong key refuses the whole request: part of it would do something else.
    if (!good) return std::nullopt;
  }
  return request;
}

}  // namespace tact::host::server
