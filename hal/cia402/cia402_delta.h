// cia402_delta.h - a delta with three CiA 402 drives in cyclic synchronous torque, as a device.
//
//     write: [heartbeat of the host, every 5 ms]  command 1, 2, 3  SYNC        one sendmmsg
//     read:  the three samples of that SYNC, EMCY, heartbeats                  one recvmmsg
//
//     off --permit--> starting: 0x06 0x07 0x0F --all three enabled--> ready --not permitted--> off
//
// SYNC is the last frame, so all drives sample at one time, and what they saw is there at the next
// tick; a sample is fresh, with power or without, when all three have come since the last read.
// Without samples the torques fade (sample_gap.h). Torque is zero until all three are enabled. When
// they let go they are told not to wait for the host's heartbeat (heartbeat_guard.h). A drive that
// faults, leaves operation enabled or sends EMCY stops all three by quick stop, and no fault is
// ever reset here: only opening the device anew does that. Without the loop its heartbeat is
// missing and the drives stop by themselves (1016, 6007). A drive that repeats an old position in
// answer to a new SYNC cannot be told from one at rest: its sample has no velocity that would say
// otherwise, as an ODrive's has (odrive_axis.h). CiA 301, CiA 402-2.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "hal/can/can_bus.h"
#include "hal/can/can_delta.h"
#include "hal/can/sample_gap.h"
#include "hal/cia402/cia402_bring_up.h"
#include "hal/cia402/cia402_state.h"
#include "hal/cia402/cia402_trouble.h"
#include "hal/cia402/heartbeat_guard.h"
#include "hal/device.h"
#include "model/result.h"
#include "model/scene.h"

namespace tact::hal {

struct Cia402Counts {
  std::uint64_t extra = 0;   // a second sample of a drive in one tick: the newer one is taken
  std::uint64_t old = 0;     // samples from before the last read
  std::uint64_t strays = 0;  // frames that nobody asked for
};

class Cia402Delta final : public Device {
 public:
  Cia402Delta(std::unique_ptr<CanBus> bus, const model::DeviceSettings& settings, double rate_Hz,
              const Cia402Start& start);
  ~Cia402Delta() override;

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
    return with_bus({{"strays", counts_.strays}, {"old", counts_.old}, {"extra", counts_.extra}},
                    bus_->counts());
  }
  void stop() override;

  /// Set-up: why the positions at the start cannot be right, if so.
  std::optional<model::Error> check_home(const Cia402Start& start) const {
    return delta_.check_home(start.motor_turns);
  }
  const Cia402Counts& counts() const { return counts_; }
  const CanBusCounts& bus_counts() const { return bus_->counts(); }

 private:
  enum class Phase : std::uint8_t { kOff, kStarting, kReady, kStopped };
  struct Axis {
    int node = 0;
    double rated_torque_Nm = 0.0;
    bool sampled = false;  // since the last read
    Cia402State state = Cia402State::kUnknown;
    std::uint16_t controlword = kControlDisableVoltage;  // sent last
    double turns = 0.0;
    std::int64_t arrival_ns = 0;
    std::int64_t heartbeat_ns = 0;
    int idle_ticks = 0;  // enabled without following, in a row
    HeartbeatGuard guard;
  };

  void take(std::size_t axis, const CanReceived& received, std::int64_t now_ns) RT_SAFE;
  void take_sample(std::size_t axis, const CstSample& sample, std::int64_t arrival_ns) RT_SAFE;
  void watch(std::int64_t now_ns) RT_SAFE;
  void follow_phase(std::int64_t now_ns) RT_SAFE;
  bool measure(Tool& tool, std::int64_t& stamp_ns) RT_SAFE;
  void judge_gap(bool fresh) RT_SAFE;
  void latch(std::size_t axis, Cia402Cause kind, std::uint32_t code,
             Fault fault = Fault::kDriveFault) RT_SAFE;
  bool all_sampled() const RT_SAFE;
  bool all_enabled() const RT_SAFE;
  std::uint16_t controlword_of(const Axis& axis) const RT_SAFE;
  void push_command(Axis& axis, std::uint16_t controlword, double torque_Nm) RT_SAFE;
  void push_heartbeat() RT_SAFE;

  std::unique_ptr<CanBus> bus_;
  model::DeviceSettings settings_;
  CanDelta delta_;
  CstConfiguration configuration_;
  std::int64_t period_ns_;
  int ticks_per_heartbeat_;
  std::array<Axis, 3> axes_;
  Phase phase_ = Phase::kOff;
  bool permitted_ = false;
  std::int64_t now_ns_ = 0;     // of the last read; 0: none yet
  std::int64_t before_ns_ = 0;  // of the read before
  std::int64_t started_ns_ = 0;
  std::uint64_t ticks_ = 0;
  int stops_to_send_ = 3;  // after a fault
  std::uint64_t sequence_ = 0;
  SampleGap gap_;
  Cia402Counts counts_;
  FaultLatch latch_;
};

/// From a bus that is open: what remains when interface and socket are checked.
model::Result<std::unique_ptr<Device>> start_cia402_delta(std::unique_ptr<CanBus> bus,
                                                          const model::DeviceSettings& settings,
                                                          double rate_Hz);

model::Result<std::unique_ptr<Device>> open_can_cia402(const model::Scene& scene);

}  // namespace tact::hal
