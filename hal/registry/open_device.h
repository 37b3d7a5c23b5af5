// SPDX-License-Identifier: Apache-2.0
// open_device.h - from the scene's device.kind to a device: the one place in hal that knows
// the names.
#pragma once

#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/sim/hand_socket.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::hal::registry {

/// Stops the device before it goes: no early exit leaves a force or power behind.
struct StopAndDelete {
  void operator()(Device* device) const;
};
using OpenDevice = std::unique_ptr<Device, StopAndDelete>;

/// Opens what scene.device names. Set-up only; may take as long as the hardware needs.
model::Result<OpenDevice> open_device(const model::scene::Scene& scene);

/// The network interface that this device needs, while it is not there or not up; else empty.
std::string missing_interface(const model::DeviceSettings& settings);

/// True for a kind that is no hardware: it may be run on simulated time.
bool is_simulated(const model::DeviceSettings& settings);
/// True for a device whose hand is simulated and may be moved by a person.
bool is_simulated(const Device& device);

/// Lets a person move the hand of a simulated device; the device must outlive the socket.
model::Result<std::unique_ptr<sim::HandSocket>> start_hand_socket(Device& device,
                                                                  const std::string& path);

}  // namespace tact::hal::registry
