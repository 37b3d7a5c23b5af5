// SPDX-License-Identifier: Apache-2.0
// scene_device.h - the keys of [device]: every device's own section, and the safety lines.
#pragma once

#include <string>

#include "model/device_settings.h"
#include "model/scene/scene_reader.h"

namespace tact::model::scene {

void visit_device(Keys& keys, DeviceSettings& out);

}  // namespace tact::model::scene
