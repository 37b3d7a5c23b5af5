// SPDX-License-Identifier: Apache-2.0
// scene_limits.h - the keys of [limits]: what the gate lets through, and which limits fit together.
// Set-up code.
#pragma once

#include "model/reader/scene_reader.h"
#include "model/scene/scene.h"

namespace tact::model::scene {

void visit_limits(reader::Keys& k, double rate_Hz, Limits& limits);

/// The shortest limits.thermal_time_s with which the RMS of the force stays below its continuous
/// value (firmware/gate/thermal_limit.h); 0 where nothing is continuous, or no rate is known.
double least_thermal_time_s(const Limits& limits, double rate_Hz);

}  // namespace tact::model::scene
