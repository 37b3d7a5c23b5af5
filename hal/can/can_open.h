// SPDX-License-Identifier: Apache-2.0
// can_open.h - from the name of a CAN interface to a checked socket.
//
// Set-up code only.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/can/can_link.h"
#include "hal/can/can_settings.h"
#include "hal/can/can_socket.h"
#include "model/result.h"

namespace tact::hal::can {

/// Asks the kernel. Error: no such interface, or the text of the kernel.
model::Result<CanLink> read_can_link(const std::string& name);

/// Asks for the link, checks it, and opens a raw socket that knows its rate: for data frames of
/// exactly these identifiers, and for error frames. Of CAN FD: a small identifier may come as an
/// extended one, and all frames come whose lowest seven bits are one of `nodes`.
model::Result<std::unique_ptr<CanSocket>> open_checked_can(const std::string& name, int cycle_bits,
                                                           double rate_Hz,
                                                           std::span<const std::uint32_t> ids);
model::Result<std::unique_ptr<CanFdSocket>> open_checked_can(const std::string& name,
                                                             const CanFdBits& cycle, double rate_Hz,
                                                             std::span<const std::uint32_t> ids,
                                                             std::span<const int> nodes);

/// Locks the drives of a scene for this process alone (hal/device_lock.h), node by node.
/// `gives_sync`: also the role of the SYNC producer, of which a bus has one. No error if the
/// interface does not exist.
std::optional<model::Error> lock_drives(const CanSettings& settings, bool gives_sync);

}  // namespace tact::hal::can
