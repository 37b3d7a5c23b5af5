// SPDX-License-Identifier: Apache-2.0
// scene_device.h - the keys of [device]: every device's own section, and the safety lines.
#pragma once

#include <string>

#include "model/device_settings.h"
#include "model/reader/scene_reader.h"

namespace tact::model::scene {

void visit_device(reader::Keys& keys, DeviceSettings& out);

}  // namespace tact::model::scene
