// SPDX-License-Identifier: Apache-2.0
// library_device.h - a device that its vendor SDK drives.
//
// The loop only exchanges slots with the thread that calls the library (library_worker.h): no
// system call in read or write. Velocities come from the shared observer. A sample is fresh when it
// is new, younger than 5 ms, and the forces are on whenever they may be: while power is not
// permitted the device still reports its pose, so that a fault can be reset.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/velocity_observer.h"
#include "hal/vendor_sdk/library_worker.h"

namespace tact::hal::vendor_sdk {

/// The caution of every such device, for `DeviceInfo::caution`.
inline constexpr const char* kNoGuardian =
    "if tactd is killed or the library hangs, nothing zeroes this device, because its vendor's "
    "library shares no handle: put its supply on a relay";

/// For `DeviceInfo::caution`, "; " first: the damping is the default of this key. Empty where the
/// scene gives one of its own.
std::string assumed_damping_text(double damping_Ns_per_m, double default_Ns_per_m, const char* key);

class LibraryDevice final : public Device {
 public:
  LibraryDevice(DeviceInfo info, std::shared_ptr<LibraryWorker> worker);
  ~LibraryDevice() override;
  LibraryDevice(const LibraryDevice&) = delete;
  LibraryDevice& operator=(const LibraryDevice&) = delete;

  DeviceInfo info() const override { return info_; }
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  bool ready() const RT_SAFE override { return permitted_ && follows_; }
  void permit(bool powered) RT_SAFE override { permitted_ = powered; }
  void set_grip_force(double opening_N) RT_SAFE override { grip_N_ = opening_N; }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  std::string fault_detail() const override;
  void stop() override;
  std::string why_not_off() const override;

 private:
  void observe(const LibraryPose& pose, Sample& sample) RT_SAFE;

  DeviceInfo info_;
  std::shared_ptr<LibraryWorker> worker_;
  VelocityObserver linear_, angular_, gap_;
  LibraryPose before_;
  Vec3 turned_rad_;  // all rotations since the start, added up
  std::int64_t now_ns_ = 0;
  double grip_N_ = 0.0;
  bool permitted_ = false;
  bool follows_ = false;  // the newest pose: forces are on
  std::atomic<bool> stopped_{false}, stuck_{false};
};

}  // namespace tact::hal::vendor_sdk
