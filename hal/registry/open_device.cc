// SPDX-License-Identifier: Apache-2.0
#include "hal/registry/open_device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

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
#include "model/reader/scene_reader.h"

namespace tact::hal::registry {
namespace {

using model::DeviceSettings;
using model::Error;
using model::Result;
using model::reader::Keys;

using Opened = Result<std::unique_ptr<Device>>;

Opened simulated(const model::scene::Scene& scene, const sim::SimDeviceSettings& settings) {
  auto device = sim::make_sim_delta(settings, scene.hand, mounting_of(scene.device));
  if (!device) return device.error();
  return std::unique_ptr<Device>(std::move(*device));
}

Opened open_sim_delta(const model::scene::Scene& scene) {
  return simulated(scene, scene.device.of<sim::SimDeviceSettings>());
}

Opened open_sim_ideal(const model::scene::Scene& scene) { return simulated(scene, sim::kIdeal); }

/// A device's own function.
template <Opened (*open)(const DeviceSettings&, double)>
Opened opened(const model::scene::Scene& scene) {
  return open(scene.device, scene.rate_Hz);
}

/// The section of `Settings`. `More` have keys of their own in it.
template <typename Settings, typename... More>
void visit_section(Keys& k, DeviceSettings& out, bool chosen) {
  constexpr Section kSection = Settings::kSection;
  const auto visit = [&out](Keys& section) {
    out.of<Settings>().visit(section);
    (out.of<More>().visit(section, out), ...);
  };
  const bool required = chosen && kSection.required;
  k.section(kSection.key, kSection.meaning, visit,
            required ? model::Need::kRequired : model::Need::kOptional);
}

void visit_can(Keys& k, DeviceSettings& out, bool chosen) {
  visit_section<can::DeltaSettings>(k, out, chosen);
  visit_section<can::CanSettings, odrive::OdriveSettings, cia402::Cia402Settings>(k, out, chosen);
}

/// A device.
struct Row {
  std::string_view kind;  // device.kind
  Opened (*open)(const model::scene::Scene&);
  /// Its sections below [device]; `chosen`: the scene names this kind. Rows next to each other may
  /// share theirs. Null: it has no settings.
  void (*keys)(Keys&, DeviceSettings&, bool chosen) = nullptr;
  std::span<const UsbPart> usb{};  // what it is when it is plugged in
  bool simulated = false;          // no hardware: it may be run on simulated time
};
constexpr Row kRows[] = {
    {"sim-delta", open_sim_delta, visit_section<sim::SimDeviceSettings>, {}, true},
    {"sim-ideal", open_sim_ideal, nullptr, {}, true},
    {"can-odrive", opened<odrive::open_can_odrive>, visit_can},
    {"can-cia402", opened<cia402::open_can_cia402>, visit_can},
    {"can-moteus", opened<moteus::open_can_moteus>, visit_can},
    {"falcon", opened<falcon_usb::open_falcon>, visit_section<falcon::FalconSettings>,
     falcon::kFalconParts},
    {"force-dimension", opened<force_dimension::open_force_dimension>,
     visit_section<force_dimension::ForceDimensionSettings>, force_dimension::kForceDimensionParts},
    {"phantom", opened<phantom::open_phantom>, visit_section<phantom::PhantomSettings>,
     phantom::kPhantomParts}};

const Device* on_base(const Device* device) {
  const auto* mounted = dynamic_cast<const MountedDevice*>(device);
  return mounted != nullptr ? &mounted->inner() : device;
}

}  // namespace

void StopAndDelete::operator()(Device* device) const {
  device->stop();
  delete device;
}

void visit_device(Keys& k, DeviceSettings& out) {
  k.text("kind", "sim-delta and sim-ideal are simulated; tactd --list-devices", out.kind);
  k.vector("base_orientation_deg", {-360.0, 360.0},
           "turn of its base, axis times angle; 0: axis towards you", out.base_orientation_deg,
           model::Need::kOptional);
  k.vector("base_position_m", {-0.5, 0.5}, "where the middle of its workspace is, in W",
           out.base_position_m, model::Need::kOptional);
  k.number("motion_scale", {0.1, 10.0}, "way of the tool for a way of the handle", out.motion_scale,
           model::Need::kOptional);
  // Without a kind, as where the reference is written, the first device is the one to show.
  const std::string_view kind = out.kind.empty() ? kRows[0].kind : out.kind;
  for (const Row* row = kRows; row != std::end(kRows); ++row) {
    if (row->keys == nullptr || (row != kRows && row[-1].keys == row->keys)) continue;
    row->keys(k, out, std::ranges::any_of(kRows, [&](const Row& one) {
                return one.keys == row->keys && one.kind == kind;
              }));
  }
  visit_section<LinesSettings>(k, out, false);
}

Result<model::scene::Scene> load_scene(const std::string& path,
                                       const std::vector<std::string>& overrides) {
  return model::scene::load_scene(path, overrides, visit_device);
}

std::vector<std::string> device_kinds() {
  std::vector<std::string> kinds;
  for (const Row& row : kRows) kinds.emplace_back(row.kind);
  return kinds;
}

std::vector<UsbPart> usb_parts() {
  std::vector<UsbPart> parts;
  for (const Row& row : kRows) parts.insert(parts.end(), row.usb.begin(), row.usb.end());
  return parts;
}

Result<OpenDevice> open_device(const model::scene::Scene& scene) {
  const auto* row = std::ranges::find(kRows, scene.device.kind, &Row::kind);
  if (row == std::end(kRows))
    return Error{
        fmt::format("{}: device.kind is \"{}\", which this build does not know; use \"{}\"",
                    scene.path, scene.device.kind, fmt::join(device_kinds(), "\", \""))};
  auto device = row->open(scene);
  if (!device) return Error{fmt::format("{}: {}", scene.path, device.error().message)};
  // Any other mounting than that of W itself wraps the device.
  if (const Mounting mounting = mounting_of(scene.device); mounting != Mounting{})
    return OpenDevice(new MountedDevice(std::move(*device), mounting));
  return OpenDevice(device->release());
}

std::string missing_interface(const DeviceSettings& settings) {
  if (!can::is_on_can(settings)) return {};
  const std::string& interface = settings.of<can::CanSettings>().interface;
  const auto link = can::read_can_link(interface);
  return link && link->up ? std::string() : interface;
}

bool is_simulated(const DeviceSettings& settings) {
  return std::ranges::any_of(
      kRows, [&](const Row& row) { return row.simulated && settings.kind == row.kind; });
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
