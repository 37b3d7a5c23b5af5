// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/force_dimension_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hal/saturation.h"

namespace tact::hal::force_dimension {
namespace {

// Chosen: twenty cycles of the thread.
constexpr std::int64_t kOldest_ns = 5'000'000;
constexpr double kObserver_Hz = 40.0;
constexpr double kJump_m = 0.02, kJump_rad = 0.5;  // between two samples: a new start
constexpr double kDelay_s = 0.75e-3;  // a cycle of the thread before the loop, one after, and USB

/// The rotation vector of q, at most half a turn. |q| = 1.
Vec3 rotation_vector_rad(const model::Quat& q) RT_SAFE {
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Vec3 v{sign * q.x, sign * q.y, sign * q.z};
  const double s = norm(v);
  // Near zero the quotient loses its digits; there the vector part is half the angle.
  return s > 1e-12 ? v * (2.0 * std::atan2(s, sign * q.w) / s) : 2.0 * v;
}

DeviceInfo info_of(const SdkSession& session, const model::ForceDimensionSettings& settings) {
  const ForceDimensionType& type = session.type;
  return {.name = session.serial_number == 0
                      ? fmt::format("Force Dimension {}", type.name)
                      : fmt::format("Force Dimension {} no. {}", type.name, session.serial_number),
          .max_force_N = type.max_force_N,
          .max_torque_Nm = type.max_torque_Nm,
          .workspace_radius_m = type.radius_m,
          .workspace_half_length_m = type.half_length_m,
          .at_tool = model::DeviceAtTool{.damping_Ns_per_m = settings.damping_Ns_per_m,
                                         .friction_N = 0.0,  // the maker tells none
                                         .position_step_m = type.resolution_m,
                                         .delay_s = kDelay_s},
          .damping_key = "device.force_dimension.damping_Ns_per_m",
          .caution =
              "if tactd is killed, nothing zeroes this device, because its maker's library "
              "shares no handle: put its supply on a relay"};
}

/// Three periods of the loop, and never less than the age of a good sample.
std::int64_t command_life_ns(double rate_Hz) {
  return std::max(kOldest_ns, static_cast<std::int64_t>(3e9 / rate_Hz));
}

}  // namespace

ForceDimensionDevice::ForceDimensionDevice(const SdkSession& session,
                                           const model::ForceDimensionSettings& settings,
                                           double rate_Hz)
    : info_(info_of(session, settings)),
      worker_(SdkWorker::start(session, rate_Hz, command_life_ns(rate_Hz))),
      linear_(kObserver_Hz, kJump_m),
      angular_(kObserver_Hz, kJump_rad) {}

ForceDimensionDevice::~ForceDimensionDevice() { stop(); }

Fault ForceDimensionDevice::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  now_ns_ = now_ns;
  sample.fresh = false;
  if (const Fault fault = worker_->trouble().fault; fault != Fault::kNone) return fault;
  SdkPose pose;
  if (!worker_->poses().read(pose)) return Fault::kNone;
  // The forces are still off, or show zero first: an armed loop would trust a force that is not
  // there.
  if (permitted_ && !pose.follows_commands) return Fault::kNone;
  if (now_ns - pose.stamp_ns > kOldest_ns) return Fault::kNone;
  sample.tool.position_m = pose.position_m;
  sample.tool.orientation = pose.orientation;
  observe(pose, sample.tool);
  sample.stamp_ns = pose.stamp_ns;
  sample.sequence = pose.sequence;
  sample.fresh = true;
  return Fault::kNone;
}

void ForceDimensionDevice::observe(const SdkPose& pose, Tool& tool) RT_SAFE {
  const double elapsed_s = 1e-9 * static_cast<double>(pose.stamp_ns - before_.stamp_ns);
  const Vec3 turn_rad = rotation_vector_rad(pose.orientation * conjugate(before_.orientation));
  // Turns add up: the observer needs a line, and a quaternion's coordinates are none.
  turned_rad_ = is_finite(turn_rad) ? turned_rad_ + turn_rad : Vec3{};
  tool.velocity_mps = linear_.step(pose.position_m, elapsed_s);
  tool.angular_velocity_radps = angular_.step(turned_rad_, elapsed_s);
  before_ = pose;
}

Fault ForceDimensionDevice::write(const Wrench& wrench) RT_SAFE {
  const Wrench within{.force_N = saturated(wrench.force_N, info_.max_force_N),
                      .torque_Nm = saturated(wrench.torque_Nm, info_.max_torque_Nm)};
  worker_->commands().write({.wrench = within, .stamp_ns = now_ns_, .powered = permitted_});
  return worker_->trouble().fault;
}

std::string ForceDimensionDevice::trouble() const {
  return words_of_sdk_trouble(worker_->trouble());
}

void ForceDimensionDevice::stop() {
  // Once: the library's device is closed by it.
  if (!stopped_) worker_->stop();
  stopped_ = true;
}

model::Result<std::unique_ptr<Device>> open_force_dimension(const model::DeviceSettings& settings,
                                                            double rate_Hz) {
  const auto session = open_sdk_session(settings.force_dimension);
  if (!session) return session.error();
  return std::unique_ptr<Device>(
      new ForceDimensionDevice(*session, settings.force_dimension, rate_Hz));
}

}  // namespace tact::hal::force_dimension
