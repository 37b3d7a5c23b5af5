// SPDX-License-Identifier: Apache-2.0
// figure_json.h - the operator's figure as JSON text for the page.
//
//     once       {"joints":["pelvis",..],"capsules":[{"a":0,"b":1,"radius_a_m":..,"radius_b_m":..,
//                "depth_ratio":..,"holds_tool":false},..],"sides":[15,10],"hand":14,"head":3}
//     per frame  {"kind":"figure","tick":..,"joint_m":[x,y,z, x,y,z, ..],"head":[w,x,y,z],
//                "grip_m":[..],"reached":true,"error_mm":..,"sweeps":..,"updates":..,
//                "full_chain":false,"trouble":0,"words":"head lost (silent)",
//                "head_tracked":false}
//
// The figure is a separate message after its frame, so that the length of a frame with a full patch
// does not grow. trouble: 0 none, 1 held, 2 lost, 3 out of reach.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/figure/figure.h"

namespace tact::host::figure {

inline constexpr std::size_t kMaxFigureJsonBytes = 1024;

nlohmann::json skeleton_json(const BodyPlan& plan);
/// `head_tracked`: the head's pose is the tracker's, so a view may follow it.
std::string figure_json(const FigurePose& pose, std::uint64_t tick, bool head_tracked);

}  // namespace tact::host::figure
