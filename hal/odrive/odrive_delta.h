// odrive_delta.h - a delta with three ODrives on one CAN bus, as a haptic device.
//
//     off --permit--> starting --three heartbeats say closed loop--> ready --not permitted--> off
//     zero torque     zero torque, closed loop asked for            torques   zero torque, idle
//
// Every tick: one recvmmsg, one sendmmsg. A sample is fresh, with power or without, when a new
// position has come and none of the three is older than one and a half periods: drives run on their
// own clocks, so now and then a tick gets no frame of one axis and the next gets two. Its stamp is
// the arrival of the oldest of the three. Without samples the torques fade (sample_gap.h). A fault
// sends zero torque and Estop, which a drive keeps until its errors are cleared; only opening the
// device anew does that. Without the loop the drives' own watchdogs stop them (ODrive:
// axis.config.enable_watchdog, watchdog_timeout 0.005 to 0.02 s).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "hal/can/can_bus.h"
#include "hal/can/can_delta.h"
#include "hal/can/sample_gap.h"
#include "hal/device.h"
#include "hal/odrive/odrive_axis.h"
#include "hal/odrive/odrive_bring_up.h"
#include "model/result.h"
#include "model/scene.h"

namespace tact::hal {

struct OdriveCounts {
  std::uint64_t old = 0, stale = 0, jumped = 0;  // positions that were not taken
  std::uint64_t strays = 0;                      // frames of nodes or kinds that are not ours
};

class OdriveDelta final : public Device {
 public:
  OdriveDelta(std::unique_ptr<CanBus> bus, const model::DeviceSettings& settings, double rate_Hz,
              const OdriveStart& start);
  ~OdriveDelta() override;

  DeviceInfo info() const override;
  Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  void permit(bool powered) RT_SAFE override { permitted_ = powered; }
  bool ready() const RT_SAFE override {
    return phase_ == Phase::kReady && permitted_ && latch_.fault() == Fault::kNone;
  }
  Fault write(const Wrench& wrench) RT_SAFE override;
  std::span<const int> loop_calls() const override { return CanSocket::kLoopCalls; }
  std::string trouble() const override;
  std::vector<DeviceCount> tally() const override {
    return with_bus({{"strays", counts_.strays},
                     {"old", counts_.old},
                     {"stale", counts_.stale},
                     {"jumped", counts_.jumped}},
                    bus_->counts());
  }
  void stop() override;

  /// Set-up: why the positions at the start cannot be right, if so.
  std::optional<model::Error> check_home(const OdriveStart& start) const {
    return delta_.check_home(start.motor_turns);
  }
  const OdriveCounts& counts() const { return counts_; }
  const CanBusCounts& bus_counts() const { return bus_->counts(); }

 private:
  enum class Phase : std::uint8_t { kOff, kStarting, kReady, kStopped };

  void take(const CanReceived& received, std::int64_t now_ns) RT_SAFE;
  void take_heartbeat(std::size_t axis, const CanFrame& frame, std::int64_t arrival_ns) RT_SAFE;
  void judge_error(std::size_t axis, OdriveCause kind, std::uint32_t code,
                   std::int64_t arrival_ns) RT_SAFE;
  void watch(std::int64_t now_ns) RT_SAFE;
  void follow_phase(std::int64_t now_ns) RT_SAFE;
  bool measure(Tool& tool, std::int64_t& stamp_ns) RT_SAFE;
  void judge_gap(bool fresh) RT_SAFE;
  void latch(std::size_t axis, OdriveCause kind, std::uint32_t code,
             Fault fault = Fault::kDriveFault) RT_SAFE;
  void push_torques(const Joints& torque_Nm) RT_SAFE;
  void push_state(OdriveAxisState state) RT_SAFE;
  void push_phase(const Wrench& wrench) RT_SAFE;
  bool all_in_closed_loop() const RT_SAFE;

  std::unique_ptr<CanBus> bus_;
  model::DeviceSettings settings_;
  CanDelta delta_;
  OdriveGeneration generation_;
  std::int64_t period_ns_;
  std::array<OdriveAxis, 3> axes_;
  Phase phase_ = Phase::kOff;
  bool permitted_ = false;
  bool any_new_ = false;
  bool cleared_ = false;       // errors of the time between opening and the first tick
  std::int64_t now_ns_ = 0;    // of the last read
  std::int64_t first_ns_ = 0;  // of the first one; 0: none yet
  std::int64_t asked_ns_ = 0;  // closed loop
  int ticks_in_phase_ = 0;
  int stops_to_send_ = 3;  // after a fault
  std::uint64_t sequence_ = 0;
  SampleGap gap_;
  OdriveCounts counts_;
  FaultLatch latch_;
};

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_odrive_delta(std::unique_ptr<CanBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_odrive(const model::Scene& scene);

}  // namespace tact::hal
