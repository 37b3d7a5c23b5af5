// SPDX-License-Identifier: Apache-2.0
// replay_request.h - what a page may ask of a recording that is shown: where, whether and how fast
// it plays.
//
//     {"replay": {"playing": true, "at_s": 1.5, "step_frames": -1,
//                 "speed_ratio": 0.25, "repeats": false}}
//
// Each key may be missing. It reaches a tact-view that replays and nothing behind it: there is no
// tactd that could hear it.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tact::host::server {

struct ReplayRequest {
  std::optional<bool> playing;
  std::optional<double> at_s;         // since the first frame
  std::optional<int> step_frames;     // from the frame that is shown; the replay then rests
  std::optional<double> speed_ratio;  // 1: as it was; > 0
  std::optional<bool> repeats;        // at its end it begins again
};

using Steer = std::function<void(const ReplayRequest&)>;

/// None if the message has no "replay", or one that is not sensible.
std::optional<ReplayRequest> parse_replay(const std::string& text);

}  // namespace tact::host::server
