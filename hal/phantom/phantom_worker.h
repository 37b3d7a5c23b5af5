// SPDX-License-Identifier: Apache-2.0
// phantom_worker.h - what the library's own thread does for tact, 1000 times a second.
//
// The library drives its device from a thread of its own, its scheduler (HD-3), and calls
// `on_cycle` there: take the device's state, evaluate it, set the newest force, send it, pass the
// pose on. The thread becomes "tact-phantom", SCHED_FIFO 78, below the loop. What it shares with
// the loop, and what follows from a fault: library_worker.h. Any error of the library is a
// fault, and so are forces that are off, a calibration that is lost, and a pose that is no
// number.
//
// A frame with a fault carries zero force. The force output is switched only after a frame that
// carried zero.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "hal/phantom/phantom_session.h"
#include "hal/vendor_sdk/library_worker.h"

namespace tact::hal::phantom {

/// The scheduler's rate (HD-3).
inline constexpr double kPhantomRate_Hz = 1000.0;

class PhantomWorker final : public vendor_sdk::LibraryWorker {
 public:
  /// Starts the scheduler, for a loop of that rate, and waits until the device is calibrated. It
  /// closes the device when that fails.
  static model::Result<std::shared_ptr<PhantomWorker>> start(const PhantomSession& session,
                                                             double rate_Hz);

 private:
  enum class Source : std::uint8_t { kNone, kError, kForceOff, kCalibration, kPose };

  PhantomWorker(const PhantomSession& session, double rate_Hz)
      : LibraryWorker(static_cast<std::int64_t>(1e9 / kPhantomRate_Hz), rate_Hz),
        session_(session) {}
  std::optional<model::Error> wait_until_calibrated();
  static unsigned on_cycle(void* of);
  bool cycle();
  void exchange();
  bool evaluate(vendor_sdk::LibraryPose& pose);
  bool errors();
  void send(const model::Vec3& force_N);
  void let_go();
  bool switch_forces(bool on) override;
  void switch_output();
  std::string cause_text() const override;
  void close() override;
  bool fail(model::Fault fault, Source source, unsigned code);

  PhantomSession session_;
  std::shared_ptr<PhantomWorker> self_;  // while the library may call
  bool entered_ = false;                 // the library's thread, as the next two
  bool wanted_on_ = false, output_on_ = false;
  std::atomic<unsigned> calibration_{0};  // what the library reported last; 0: nothing yet
  std::atomic<bool> calibrated_{false};   // once
};

}  // namespace tact::hal::phantom
