// SPDX-License-Identifier: Apache-2.0
// library_worker.h - what the threads that call a vendor SDK share with the loop.
//
// The library may wait for USB, for locks, for threads of its own; the loop never calls it. It
// exchanges the newest pose and the newest command with the worker's thread, which calls the
// library once a cycle:
//
//   a command that the loop has not renewed for its life is worth zero;
//   without one for 100 ms, or without power, the forces are switched off;
//   they come back through 2 ms of zero force, so that no step goes into the hand.
//
// The first fault is kept. After it: zero force, then forces off, then not one call more. A
// library that does not return cannot be ended from here: the last force may stay in the motors,
// and all that is left is to say so.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/fault_latch.h"
#include "hal/threads/latest_slot.h"
#include "model/types.h"

namespace tact::hal::vendor_sdk {

struct LibraryPose {
  model::Vec3 position_m;
  model::Quat orientation;
  double grip_ratio = 0.0;        // 0 open, 1 closed
  double grip_gap_m = 0.0;        // between the fingers
  std::int64_t stamp_ns = 0;      // CLOCK_MONOTONIC before the library was asked
  std::uint64_t sequence = 0;     // of poses
  bool follows_commands = false;  // forces are on, zero force has been shown first
};

struct LibraryForce {
  model::Wrench wrench;
  double grip_N = 0.0;  // on the fingers, opening positive
};

struct LibraryCommand {
  LibraryForce force;
  std::int64_t stamp_ns = 0;  // of the tick that made it
  bool powered = false;
};

/// How long a sample is good, and a command at least.
inline constexpr std::int64_t kOldest_ns = 5'000'000;
/// A library whose last cycle is older than this has fallen silent.
inline constexpr std::int64_t kLibrarySilence_ns = 20'000'000;

class LibraryWorker {
 public:
  LibraryWorker(const LibraryWorker&) = delete;
  LibraryWorker& operator=(const LibraryWorker&) = delete;
  virtual ~LibraryWorker() = default;

  threads::LatestSlot<LibraryPose>& poses() RT_SAFE { return poses_; }
  threads::LatestSlot<LibraryCommand>& commands() RT_SAFE { return commands_; }
  /// Its kind is that of the device's folder, its code the library's.
  FaultCause first_cause() const RT_SAFE { return cause_.cause(); }
  /// For a person: the first fault, and a library that has fallen silent; empty without either.
  std::string fault_text(std::int64_t now_ns) const;

  /// Ends the threads, zeroes the force and closes the device; false when the library did not
  /// return within `timeout`: then it is not closed, its last force may stay, and the process,
  /// while the library hangs, ends without the destructors that would wait for it. Once.
  [[nodiscard]] bool stop(std::chrono::milliseconds timeout = std::chrono::seconds(2));

 protected:
  /// For a loop of this rate.
  LibraryWorker(std::int64_t cycle_ns, double rate_Hz);

  /// Gives the calling thread its name, and SCHED_FIFO below the loop, which a black box must not
  /// delay.
  static void enter_fifo(const char* name);

  // The thread of the cycle.
  /// Passes on what the library reported in this cycle.
  void publish(LibraryPose pose);
  /// Switches the forces as the loop wants them; the force of this cycle, or nothing when the
  /// forces did not switch.
  std::optional<LibraryForce> next_force(std::int64_t now_ns);
  /// Switches the forces, or notes that they shall be; the force is zero in this cycle and, after
  /// "on", in the next ones. False: they do not switch.
  virtual bool switch_forces(bool on) = 0;
  virtual void close() = 0;
  /// The library has come back from all calls of a cycle.
  void cycle_ended(std::int64_t now_ns) { last_cycle_ns_ = now_ns; }
  /// There will be none more, so silence is no news.
  void cycles_ended() { last_cycle_ns_ = 0; }

  // Any thread.
  /// The first fault for a person; empty without one.
  virtual std::string cause_text() const = 0;
  std::int64_t cycle_ns() const { return cycle_ns_; }
  bool quits() const { return quit_.load(std::memory_order_relaxed); }
  /// The forces are on for so long that "off" is news.
  bool powered_for_sure() const;
  void keep(const FaultCause& cause) { cause_.set(cause); }
  /// So many threads will call the library: said before the first begins, as stop() waits for them.
  void expect_threads(int threads) { running_ = threads; }
  void thread_ends();

 private:
  enum class Power : std::uint8_t { kOff, kZeroFirst, kOn };
  bool follow_power(bool wanted);

  std::int64_t cycle_ns_, command_life_ns_;
  threads::LatestSlot<LibraryPose> poses_;
  threads::LatestSlot<LibraryCommand> commands_;
  LibraryCommand command_;  // the thread of the cycle, as the next three
  std::uint64_t sequence_ = 0;
  std::int64_t zero_cycles_ = 0;
  Power power_ = Power::kOff;
  std::atomic<std::int64_t> powered_cycles_{0};  // since the forces were switched on
  std::atomic<std::int64_t> last_cycle_ns_{0};   // CLOCK_MONOTONIC; 0: none is due
  FaultLatch cause_;
  std::atomic<bool> quit_{false}, given_up_{false};
  std::atomic<int> running_{0};
};

}  // namespace tact::hal::vendor_sdk
