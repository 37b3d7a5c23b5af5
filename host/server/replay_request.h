// SPDX-License-Identifier: Apache-2.0
// replay_request.h - a page's request to a replay: position, pause and speed.
//
//     {"replay": {"playing": true, "at_s": 1.5, "step_frames": -1,
//                 "speed_ratio": 0.25, "repeats": false}}
//
// Each key is optional. The request reaches only the tact-view that replays; there is no tactd.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace tact::host::server {

struct ReplayRequest {
  std::optional<bool> playing;
  std::optional<double> at_s;         // since the first frame
  std::optional<int> step_frames;     // relative to the shown frame; the replay then pauses
  std::optional<double> speed_ratio;  // 1: as recorded; > 0
  std::optional<bool> repeats;        // starts again at its end
};

using Steer = std::function<void(const ReplayRequest&)>;

/// The object that a page's message has under this key; null: none, or it is no JSON object.
nlohmann::json object_in(const std::string& text, const char* key);

/// None if the message has no "replay", or an invalid one.
std::optional<ReplayRequest> parse_replay(const std::string& text);

}  // namespace tact::host::server
