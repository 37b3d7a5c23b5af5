// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/library_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/monotonic.h"
#include "hal/saturation.h"
#include "hal/vendor_sdk/rotation.h"

namespace tact::hal::vendor_sdk {
namespace {

constexpr double kObserver_Hz = 40.0;

}  // namespace

std::string assumed_damping_text(double damping_Ns_per_m, double default_Ns_per_m,
                                 const char* key) {
  if (damping_Ns_per_m != default_Ns_per_m) return "";
  return fmt::format("; the damping of this device is assumed, not measured ({})", key);
}

LibraryDevice::LibraryDevice(DeviceInfo info, std::shared_ptr<LibraryWorker> worker)
    : info_(std::move(info)),
      worker_(std::move(worker)),
      linear_(kObserver_Hz, kJump_mps),
      angular_(kObserver_Hz, kJump_radps),
      gap_(kObserver_Hz, kJump_mps) {}

LibraryDevice::~LibraryDevice() { stop(); }

Fault LibraryDevice::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  now_ns_ = now_ns;
  sample.fresh = false;
  if (const Fault fault = worker_->first_cause().fault; fault != Fault::kNone) return fault;
  LibraryPose pose;
  if (!worker_->poses().read(pose)) return Fault::kNone;
  follows_ = pose.follows_commands;
  // The forces are still off, or show zero first: an armed loop would trust a force that is not
  // there.
  if (permitted_ && !pose.follows_commands) return Fault::kNone;
  if (now_ns - pose.stamp_ns > kOldest_ns) return Fault::kNone;
  sample.tool.position_m = pose.position_m;
  sample.tool.orientation = pose.orientation;
  sample.tool.grip_ratio = pose.grip_ratio;
  sample.grip_gap_m = pose.grip_gap_m;
  observe(pose, sample);
  sample.stamp_ns = pose.stamp_ns;
  sample.sequence = pose.sequence;
  sample.fresh = true;
  return Fault::kNone;
}

void LibraryDevice::observe(const LibraryPose& pose, Sample& sample) RT_SAFE {
  const double elapsed_s = 1e-9 * static_cast<double>(pose.stamp_ns - before_.stamp_ns);
  const Vec3 turn_rad = rotation_vector_rad(pose.orientation * conjugate(before_.orientation));
  // Turns add up: the observer needs a line, and a quaternion's coordinates are none.
  turned_rad_ = is_finite(turn_rad) ? turned_rad_ + turn_rad : Vec3{};
  sample.tool.velocity_mps = linear_.step(pose.position_m, elapsed_s);
  sample.tool.angular_velocity_radps = angular_.step(turned_rad_, elapsed_s);
  sample.grip_speed_mps = gap_.step({pose.grip_gap_m, 0.0, 0.0}, elapsed_s).x;
  before_ = pose;
}

Fault LibraryDevice::write(const Wrench& wrench) RT_SAFE {
  const bool sound = is_finite(wrench) && std::isfinite(grip_N_);
  const double most_N = info_.grip.max_force_N;
  const LibraryForce within{
      .wrench = {.force_N = saturated(wrench.force_N, info_.max_force_N),
                 .torque_Nm = saturated(wrench.torque_Nm, info_.max_torque_Nm)},
      .grip_N = std::clamp(grip_N_, -most_N, most_N)};
  worker_->commands().write(
      {.force = sound ? within : LibraryForce{}, .stamp_ns = now_ns_, .powered = permitted_});
  return sound ? worker_->first_cause().fault : Fault::kForceNotFinite;
}

std::string LibraryDevice::fault_detail() const {
  const std::string said = worker_->fault_text(monotonic_ns()), left = why_not_off();
  return said.empty() || left.empty() ? said + left : said + "; " + left;
}

std::string LibraryDevice::why_not_off() const {
  return stuck_ ? "the library does not return: switch the device's supply off" : "";
}

void LibraryDevice::stop() {
  // Once: the library's device is closed by it.
  if (!stopped_.exchange(true)) stuck_ = !worker_->stop();
}

}  // namespace tact::hal::vendor_sdk
