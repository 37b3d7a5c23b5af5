#include "hal/open_device.h"

#include <fmt/core.h>

#include <utility>

#include "hal/cia402/cia402_delta.h"
#include "hal/falcon/falcon_device.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/sim/sim_delta.h"

namespace tact::hal {
namespace {

using model::Error;
using model::Result;

using Opened = Result<OpenDevice>;

Opened open_sim_delta(const model::Scene& scene) {
  auto device = make_sim_delta(scene.device.sim, scene.hand);
  if (!device) return Error{fmt::format("{}: {}", scene.path, device.error().sentence)};
  return OpenDevice(device->release());
}

/// A device's own function; its sentences get the scene in front.
template <Result<std::unique_ptr<Device>> (*open)(const model::Scene&)>
Opened opened(const model::Scene& scene) {
  auto device = open(scene);
  if (!device) return Error{fmt::format("{}: {}", scene.path, device.error().sentence)};
  return OpenDevice(device->release());
}

struct Kind {
  const char* name;
  Opened (*open)(const model::Scene&);
};
constexpr Kind kKinds[] = {{"sim-delta", open_sim_delta},
                           {"can-odrive", opened<open_can_odrive>},
                           {"can-cia402", opened<open_can_cia402>},
                           {"falcon", opened<open_falcon>},
                           {"force-dimension", opened<open_force_dimension>}};

}  // namespace

void StopAndDelete::operator()(Device* device) const {
  device->stop();
  delete device;
}

Opened open_device(const model::Scene& scene) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (scene.device.kind == kind.name) return kind.open(scene);
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", kind.name);
  }
  return Error{fmt::format("{}: device.kind is \"{}\", which this build does not know; use {}",
                           scene.path, scene.device.kind, known)};
}

bool is_simulated(const model::DeviceSettings& settings) { return settings.kind == "sim-delta"; }

bool is_simulated(const Device& device) {
  return dynamic_cast<const SimDelta*>(&device) != nullptr;
}

Result<std::unique_ptr<HandSocket>> start_hand_socket(Device& device, const std::string& path) {
  auto* simulated = dynamic_cast<SimDelta*>(&device);
  if (simulated == nullptr) {
    return Error{
        fmt::format("{} has a real hand on it; start without a hand socket", device.info().name)};
  }
  return HandSocket::start(path, simulated->hand_targets());
}

}  // namespace tact::hal
