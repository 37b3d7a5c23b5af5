// SPDX-License-Identifier: Apache-2.0
// can_lock.h - the drives of a scene on one CAN bus, for one program alone (hal/device_lock.h).
#pragma once

#include <optional>

#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::can {

/// Takes each node of the bus. `gives_sync`: the one who sends SYNC to all nodes, one on a bus. An
/// interface that is not there has nothing to be taken.
std::optional<model::Error> lock_drives(const model::CanSettings& settings, bool gives_sync);

}  // namespace tact::hal::can
