// SPDX-License-Identifier: Apache-2.0
// sdk_worker.h - the two threads that call Force Dimension's library while the loop runs.
//
//   "tact-fd", SCHED_FIFO 78 (below the loop): one pose and one force every 250 us, every period of
//   a faster loop; that also feeds the watchdog and balances the device's weight.
//   "tact-fd-status", an ordinary thread: 20 times a second the status words. Forces that the
//   device has switched off by itself, lost supply or calibration become a fault that stays.
//
// What the loop and these threads share, and what follows from a fault: library_worker.h. The
// device's own watchdog does the rest.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/force_dimension/sdk_session.h"
#include "hal/vendor_sdk/library_worker.h"

namespace tact::hal::force_dimension {

/// Which call or watch found the fault.
enum class SdkCause : std::uint8_t {
  kNone,
  kPose,
  kGrip,
  kForce,
  kEnable,
  kWatch,
  kForceOff,
  kStatus
};

std::string text_of_sdk_cause(const FaultCause& cause);

/// From one pose and force to the next.
std::int64_t sdk_cycle_ns(double rate_Hz);

class SdkWorker final : public vendor_sdk::LibraryWorker {
 public:
  /// Starts both threads, for a loop of that rate.
  static model::Result<std::shared_ptr<SdkWorker>> start(const SdkSession& session, double rate_Hz);

 private:
  SdkWorker(const SdkSession& session, double rate_Hz)
      : LibraryWorker(sdk_cycle_ns(rate_Hz), rate_Hz), session_(session) {}
  std::string cause_text() const override { return text_of_sdk_cause(first_cause()); }
  void run();
  bool cycle();
  bool read_pose(std::int64_t now_ns);
  bool read_grip(vendor_sdk::LibraryPose& pose);
  bool switch_forces(bool on) override;
  void close() override { close_sdk_session(session_); }
  bool send(const vendor_sdk::LibraryForce& force);
  void watch();
  void check_status();
  bool fail(SdkCause source);
  void keep_cause(model::Fault fault, SdkCause source, int code);

  SdkSession session_;
  GripKind grip_ = grip_of(session_);
};

}  // namespace tact::hal::force_dimension
