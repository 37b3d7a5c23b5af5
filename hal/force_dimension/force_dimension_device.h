// SPDX-License-Identifier: Apache-2.0
// force_dimension_device.h - a delta.3, omega, sigma or lambda, driven through its maker's library.
//
// The loop only exchanges slots with the thread that calls the library (sdk_worker.h): no system
// call in read or write. The maker's frame is W: x towards the operator, y to the right, z up. The
// library balances the device's weight, velocities come from the shared observer. A sample is fresh
// when it is new, younger than 5 ms, and the forces are on whenever they may be: while power is not
// permitted the device still tells its pose, so that a fault can be reset.
#pragma once

#include <memory>

#include "hal/device.h"
#include "hal/force_dimension/sdk_worker.h"
#include "hal/velocity_observer.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::force_dimension {

class ForceDimensionDevice final : public Device {
 public:
  ForceDimensionDevice(const SdkSession& session, const model::ForceDimensionSettings& settings,
                       double rate_Hz);
  ~ForceDimensionDevice() override;
  ForceDimensionDevice(const ForceDimensionDevice&) = delete;
  ForceDimensionDevice& operator=(const ForceDimensionDevice&) = delete;

  DeviceInfo info() const override { return info_; }
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  void permit(bool powered) RT_SAFE override { permitted_ = powered; }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  std::string trouble() const override;
  void stop() override;

 private:
  void observe(const SdkPose& pose, Tool& tool) RT_SAFE;

  DeviceInfo info_;
  std::shared_ptr<SdkWorker> worker_;
  VelocityObserver linear_, angular_;
  SdkPose before_;
  Vec3 turned_rad_;  // all rotations since the start, added up
  std::int64_t now_ns_ = 0;
  bool permitted_ = true;
  bool stopped_ = false;
};

/// Loads the library, opens and checks the device, starts its threads; about half a second. No
/// force before the loop permits power.
model::Result<std::unique_ptr<Device>> open_force_dimension(const model::DeviceSettings& settings,
                                                            double rate_Hz);

}  // namespace tact::hal::force_dimension
