// scene_limits.h - the keys of [limits]: what the gate lets through, and which limits fit together.
// Set-up code.
#pragma once

#include "model/scene.h"
#include "model/scene_reader.h"

namespace tact::model {

void visit_limits(Keys& k, double rate_Hz, Limits& limits);

}  // namespace tact::model
