// SPDX-License-Identifier: Apache-2.0
// mounted_device.h - a device with a turned base, or whose motion is scaled (mounting.h):
// between the loop, which knows W, and the device, which knows its base.
#pragma once

#include <memory>
#include <utility>

#include "hal/device.h"
#include "hal/mounting.h"

namespace tact::hal {

class MountedDevice final : public Device {
 public:
  MountedDevice(std::unique_ptr<Device> device, const Mounting& mounting)
      : device_(std::move(device)),
        mounting_(mounting),
        turns_tool_(device_->info().turns_with_base) {}

  Device& inner() { return *device_; }
  const Device& inner() const { return *device_; }

  DeviceInfo info() const override { return mounted(device_->info(), mounting_); }
  std::span<const int> loop_calls() const override { return device_->loop_calls(); }
  std::optional<ShutdownFrames> shutdown_frames() override { return device_->shutdown_frames(); }
  void catch_up(std::int64_t now_ns) RT_SAFE override { device_->catch_up(now_ns); }
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  bool ready() const RT_SAFE override { return device_->ready(); }
  void permit(bool powered) RT_SAFE override { device_->permit(powered); }
  void set_grip_force(double opening_N) RT_SAFE override { device_->set_grip_force(opening_N); }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  void shift_tool(const Vec3& shift_m) RT_SAFE override { device_->shift_tool(shift_m); }
  void between_ticks(double elapsed_s) RT_SAFE override { device_->between_ticks(elapsed_s); }
  std::string fault_detail() const override { return device_->fault_detail(); }
  std::vector<DeviceCount> counters() const override { return device_->counters(); }
  void stop() override { device_->stop(); }
  std::string why_not_off() const override { return device_->why_not_off(); }

 private:
  std::unique_ptr<Device> device_;
  Mounting mounting_;
  bool turns_tool_;  // the handle turns with the base
  Sample of_base_;   // the newest, in B
};

}  // namespace tact::hal
