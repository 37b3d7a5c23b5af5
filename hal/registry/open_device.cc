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
#include "hal/delta/delta_frame.h"
#include "hal/falcon_usb/falcon_open.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/moteus/moteus_delta.h"
#include "hal/mounted_device.h"
#include "hal/mounting.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/phantom/phantom_device.h"
#include "hal/sim/sim_delta.h"
#include "hal/sim/sim_delta_model.h"
#include "model/reader/scene_reader.h"

namespace tact::hal::registry {
namespace {

using model::DeviceJoints;
using model::DeviceSettings;
using model::Error;
using model::Result;
using model::Vec3;
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

/// `point_D`: from the frame W of a base that lies on its side to the device's own frame.
template <typename PointD>
DeviceJoints mounted_joints(DeviceJoints joints, const DeviceSettings& settings, PointD point_D) {
  const auto of_W = [&, mounting = mounting_of(settings)](const Vec3& p_W) {
    return point_D(mounting.point_in_base(p_W));
  };
  const Vec3 origin = of_W({});
  const Vec3 x = of_W({1, 0, 0}) - origin, y = of_W({0, 1, 0}) - origin,
             z = of_W({0, 0, 1}) - origin;
  joints.row = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  joints.origin_m = {origin.x, origin.y, origin.z};
  return joints;
}

DeviceJoints delta_joints(const delta::DeltaGeometry& g, double middle_m,
                          const DeviceSettings& settings) {
  return mounted_joints({.linkage = "delta",
                         .base_radius_m = g.base_radius_m,
                         .platform_radius_m = g.platform_radius_m,
                         .upper_arm_m = g.upper_arm_m,
                         .forearm_m = g.forearm_m,
                         .azimuth_rad = g.azimuth_rad},
                        settings, [&](const Vec3& p) { return delta::point_D(p, middle_m); });
}
DeviceJoints sim_joints(const DeviceSettings& settings) {
  return delta_joints(sim::kGeometry, sim::kMiddle_D_m, settings);
}
DeviceJoints can_joints(const DeviceSettings& settings) {
  const auto& delta = settings.of<can::DeltaSettings>();
  return delta_joints(delta, delta.middle_m, settings);
}
DeviceJoints falcon_joints(const DeviceSettings& settings) {
  return mounted_joints({.linkage = "falcon"}, settings, falcon::falcon_point_D);
}

/// A device.
struct Row {
  std::string_view kind;  // device.kind
  Opened (*open)(const model::scene::Scene&);
  /// Its sections below [device]; `chosen`: the scene names this kind. Rows next to each other may
  /// share theirs. Null: it has no settings.
  void (*keys)(Keys&, DeviceSettings&, bool chosen) = nullptr;
  std::span<const UsbPart> usb{};                           // what it is when it is plugged in
  DeviceJoints (*joints)(const DeviceSettings&) = nullptr;  // null: none are known
  bool simulated = false;  // no hardware: it may be run on simulated time
};
constexpr Row kRows[] = {
    {"sim-delta", open_sim_delta, visit_section<sim::SimDeviceSettings>, {}, sim_joints, true},
    {"sim-ideal", open_sim_ideal, nullptr, {}, sim_joints, true},
    {"can-odrive", opened<odrive::open_can_odrive>, visit_can, {}, can_joints},
    {"can-cia402", opened<cia402::open_can_cia402>, visit_can, {}, can_joints},
    {"can-moteus", opened<moteus::open_can_moteus>, visit_can, {}, can_joints},
    {"falcon", opened<falcon_usb::open_falcon>, visit_section<falcon::FalconSettings>,
     falcon::kFalconParts, falcon_joints},
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

DeviceJoints joints_of(const DeviceSettings& settings) {
  const auto* row = std::ranges::find(kRows, settings.kind, &Row::kind);
  return row == std::end(kRows) || row->joints == nullptr ? DeviceJoints{} : row->joints(settings);
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
