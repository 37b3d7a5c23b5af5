// SPDX-License-Identifier: Apache-2.0
#include "hal/registry/open_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hal/can/can_open.h"
#include "hal/cia402/cia402_delta.h"
#include "hal/falcon_usb/falcon_open.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/moteus/moteus_delta.h"
#include "hal/mounted_device.h"
#include "hal/mounting.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/phantom/phantom_device.h"
#include "hal/sim/sim_delta.h"

namespace tact::hal::registry {
namespace {

using model::Error;
using model::Result;

using Opened = Result<OpenDevice>;

Opened open_sim_delta(const model::scene::Scene& scene) {
  auto device = sim::make_sim_delta(scene.device.sim, scene.hand, mounting_of(scene.device));
  if (!device) return Error{fmt::format("{}: {}", scene.path, device.error().message)};
  return OpenDevice(device->release());
}

/// A device's own function; its messages get the scene in front.
template <Result<std::unique_ptr<Device>> (*open)(const model::DeviceSettings&, double)>
Opened opened(const model::scene::Scene& scene) {
  auto device = open(scene.device, scene.rate_Hz);
  if (!device) return Error{fmt::format("{}: {}", scene.path, device.error().message)};
  return OpenDevice(device->release());
}

struct Kind {
  const char* name;
  Opened (*open)(const model::scene::Scene&);
  bool simulated = false;
};
constexpr Kind kKinds[] = {{"sim-delta", open_sim_delta, true},
                           {"can-odrive", opened<odrive::open_can_odrive>},
                           {"can-cia402", opened<cia402::open_can_cia402>},
                           {"can-moteus", opened<moteus::open_can_moteus>},
                           {"falcon", opened<falcon_usb::open_falcon>},
                           {"force-dimension", opened<force_dimension::open_force_dimension>},
                           {"phantom", opened<phantom::open_phantom>}};

/// Any other mounting than that of W itself stands between loop and device.
OpenDevice on_its_base(OpenDevice device, const Mounting& mounting) {
  if (mounting == Mounting{}) return device;
  return OpenDevice(new MountedDevice(std::unique_ptr<Device>(device.release()), mounting));
}

const Device* on_base(const Device* device) {
  const auto* mounted = dynamic_cast<const MountedDevice*>(device);
  return mounted != nullptr ? &mounted->inner() : device;
}

}  // namespace

void StopAndDelete::operator()(Device* device) const {
  device->stop();
  delete device;
}

Opened open_device(const model::scene::Scene& scene) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (scene.device.kind == kind.name) {
      auto opened = kind.open(scene);
      if (!opened) return opened;
      return on_its_base(std::move(*opened), mounting_of(scene.device));
    }
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", kind.name);
  }
  return Error{fmt::format("{}: device.kind is \"{}\", which this build does not know; use {}",
                           scene.path, scene.device.kind, known)};
}

std::string missing_interface(const model::DeviceSettings& settings) {
  if (!settings.is_on_can()) return {};
  const auto link = can::read_can_link(settings.can.interface);
  return link && link->up ? std::string() : settings.can.interface;
}

bool is_simulated(const model::DeviceSettings& settings) {
  return std::ranges::any_of(
      kKinds, [&](const Kind& kind) { return kind.simulated && settings.kind == kind.name; });
}

/// By type, not by name: only this class has a hand to move.
bool is_simulated(const Device& device) {
  return dynamic_cast<const sim::SimDelta*>(on_base(&device)) != nullptr;
}

Result<std::unique_ptr<sim::HandSocket>> start_hand_socket(Device& device,
                                                           const std::string& path) {
  auto* mounted = dynamic_cast<MountedDevice*>(&device);
  auto* simulated = dynamic_cast<sim::SimDelta*>(mounted != nullptr ? &mounted->inner() : &device);
  if (simulated == nullptr) {
    return Error{
        fmt::format("{} has a real hand on it; start without a hand socket", device.info().name)};
  }
  return sim::HandSocket::start(path, simulated->hand_targets());
}

}  // namespace tact::hal::registry
