// SPDX-License-Identifier: Apache-2.0
// sdk_worker.h - the two threads that call Force Dimension's library while the loop runs.
//
// The library may wait for USB, for locks, for threads of its own; the loop never calls it.
//
//   "tact-fd", SCHED_FIFO 78 (below the loop): one pose and one force every 250 us, every period of
//   a faster loop; that also feeds the watchdog and balances the device's weight. A command that
//   the loop has not renewed is worth zero; without it for 100 ms the forces are switched off.
//   "tact-fd-status", an ordinary thread: 20 times a second the status words. Forces that the
//   device has switched off by itself, lost supply or calibration become a trouble that stays.
//
// After a trouble: zero force and forces off once, then not one call more; the device's own
// watchdog does the rest.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "hal/force_dimension/sdk_session.h"
#include "hal/latest_slot.h"
#include "model/fault.h"
#include "model/types.h"

namespace tact::hal::force_dimension {

/// Which call or watch found the trouble.
enum class SdkTroubleSource : std::uint8_t {
  kNone,
  kPose,
  kForce,
  kEnable,
  kWatch,
  kForceOff,
  kStatus
};

/// One atomic word: fault, who found it, and the library's code.
struct SdkTrouble {
  model::Fault fault = model::Fault::kNone;
  SdkTroubleSource source = SdkTroubleSource::kNone;
  std::uint8_t code = 0;
};
std::string words_of_sdk_trouble(const SdkTrouble& trouble);

/// R, row by row, as a unit quaternion; NaN where R is no rotation.
model::Quat quat_from_rotation(const double r[3][3]);

struct SdkPose {
  model::Vec3 position_m;
  model::Quat orientation;
  std::int64_t stamp_ns = 0;      // CLOCK_MONOTONIC before the library was asked
  std::uint64_t sequence = 0;     // of poses
  bool follows_commands = false;  // forces are on, zero force has been shown first
};

struct SdkCommand {
  model::Wrench wrench;
  std::int64_t stamp_ns = 0;  // of the tick that made it
  bool powered = false;
};

/// From one pose and force to the next.
std::int64_t sdk_cycle_ns(double rate_Hz);

class SdkWorker {
 public:
  /// Starts both threads, for a loop of that rate. A command is worth command_life_ns.
  static std::shared_ptr<SdkWorker> start(const SdkSession& session, double rate_Hz,
                                          std::int64_t command_life_ns);

  LatestSlot<SdkPose>& poses() RT_SAFE { return poses_; }
  LatestSlot<SdkCommand>& commands() RT_SAFE { return commands_; }
  SdkTrouble trouble() const RT_SAFE;

  /// Ends both threads, zeroes the force and closes the device; false when the library did not
  /// return within 2 s, whereupon the device's watchdog has long let go.
  bool stop();

  SdkWorker(const SdkWorker&) = delete;
  SdkWorker& operator=(const SdkWorker&) = delete;

 private:
  enum class Power : std::uint8_t { kOff, kZeroFirst, kOn };

  SdkWorker(const SdkSession& session, std::int64_t cycle_ns, std::int64_t command_life_ns)
      : session_(session), cycle_ns_(cycle_ns), command_life_ns_(command_life_ns) {}
  void run();
  bool cycle();
  bool read_pose(std::int64_t now_ns);
  bool follow_power(bool wanted);
  bool powered_for_sure() const;
  bool send(const model::Wrench& wrench);
  void watch();
  void check_status();
  bool fail(SdkTroubleSource source);
  void keep(const SdkTrouble& trouble);

  SdkSession session_;
  std::int64_t cycle_ns_, command_life_ns_;
  LatestSlot<SdkPose> poses_;
  LatestSlot<SdkCommand> commands_;
  SdkCommand command_;  // worker thread, as the next three
  std::uint64_t sequence_ = 0;
  std::int64_t zero_cycles_ = 0;
  Power power_ = Power::kOff;
  std::atomic<std::int64_t> powered_cycles_{0};  // since the forces were switched on
  std::atomic<std::uint32_t> trouble_{0};
  std::atomic<bool> quit_{false};
  std::atomic<int> running_{0};
};

}  // namespace tact::hal::force_dimension
