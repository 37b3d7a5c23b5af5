// SPDX-License-Identifier: Apache-2.0
// scene_limits.h - the keys of [limits]: what the gate lets through, and which limits fit together.
// Set-up code.
#pragma once

#include "model/reader/scene_reader.h"
#include "model/scene/scene.h"

namespace tact::model::scene {

void visit_limits(reader::Keys& k, double rate_Hz, Limits& limits);

}  // namespace tact::model::scene
