// SPDX-License-Identifier: Apache-2.0
// open_device.h - from the scene's device.kind to a device: the one place that knows the names.
//
// A device has one row in open_device.cc: name, function that opens it, keys, simulated or not, how
// it looks when it is plugged in. All of that is written in its own folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/device.h"
#include "hal/device_facts.h"
#include "hal/lines_settings.h"
#include "hal/sim/hand_socket.h"
#include "model/device_joints.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::hal::registry {

/// Stops the device before it goes: no early exit leaves a force or power behind.
struct StopAndDelete {
  void operator()(Device* device) const;
};
using OpenDevice = std::unique_ptr<Device, StopAndDelete>;

/// Reads [device], or describes its keys.
void visit_device(model::reader::Keys& keys, model::DeviceSettings& out);
/// A scene with its device.
model::Result<model::scene::Scene> load_scene(const std::string& path,
                                              const std::vector<std::string>& overrides);

/// What device.kind may be.
std::vector<std::string> device_kinds();
/// The USB parts of all devices, for hal/list.
std::vector<UsbPart> usb_parts();

/// Opens what scene.device names. Set-up only; may take as long as the hardware needs.
model::Result<OpenDevice> open_device(const model::scene::Scene& scene);

/// How its joint angles follow from where its handle is, with its mounting.
model::DeviceJoints joints_of(const model::DeviceSettings& settings);

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
