// SPDX-License-Identifier: Apache-2.0
// cia402_drive.h - an emulated CANopen servo drive in cyclic synchronous torque mode (CiA 301,
// 402).
//
//     boot-up -> pre-operational -> (SDO) -> NMT start -> operational: SYNC -> TPDO1,
//     RPDO1 -> torque
//     switch on disabled -6-> ready -7-> switched on -F-> operation enabled
//
// Torque acts only in operation enabled, mode 10, node operational. It stops by itself when the
// host's heartbeat (1016) or the set-points (1400:5) stay out, as 6007 says. A watch ends by a
// time of zero for its node; in drives that want it off first (ObjectHabits) a zero as a whole
// leaves it. Node guarding is answered, and a pause of more than its life time (100C x 100D) is an
// emergency, beside a heartbeat too: the worst that a drive may do. A SYNC that stays out for 1.5
// times 1006, or comes without the counter of 1019, is an emergency. Where an error of the bus
// keeps a node out of operation (ObjectHabits), it ends with SYNC, the watch's end or the reset of
// its communication. Torque of the motor in 1/1000 of 6076, position in 10 000 counts per turn of
// the motor.
#pragma once

#include "tests/rig/emulators/can/can_bus.h"
#include "tests/rig/emulators/can/drive.h"
#include "tests/rig/emulators/cia402/object_dictionary.h"

namespace tact::rig {

enum class Cia402State : std::uint8_t {
  kSwitchOnDisabled,
  kReady,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStop,
  kFault,
};
/// Statusword without the bits of mode and limits.
std::uint16_t cia402_statusword(Cia402State state);
/// Where one controlword leads; bit 7 is an edge, `previous` the word before.
Cia402State cia402_next(Cia402State state, std::uint16_t controlword, std::uint16_t previous);

/// The payload of an emergency frame.
std::array<std::uint8_t, 8> cia402_emergency(std::uint16_t code, std::uint8_t error_register,
                                             std::span<const std::uint8_t> manufacturer = {});

struct Cia402Settings {
  double rated_torque_Nm = 0.32;
  int boot_ms = 20;   // from reset to the boot-up message
  int enable_ms = 5;  // from the controlword to operation enabled
  ObjectHabits habits{};
};

class Cia402Drive final : public Drive {
 public:
  /// `bus`, `motor` and `faults` outlive the drive.
  Cia402Drive(int axis, int node, const Cia402Settings& settings, CanBus& bus, const Motor& motor,
              const FaultPlan& faults);

  bool receive(const canfd_frame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;
  void fail(std::int64_t now_ns) override;
  bool warn(std::int64_t now_ns) override;
  bool is_enabled() const override { return state_ == Cia402State::kOperationEnabled; }
  double torque_Nm() const override;
  bool tripped() override;
  /// Codes of the emergencies so far, but 0: the content of its log.
  const std::vector<std::uint16_t>& noted() const { return noted_; }

 private:
  enum class Nmt : std::uint8_t {
    kBoot = 0,
    kStopped = 4,
    kOperational = 5,
    kPreOperational = 0x7F
  };

  bool is_operational() const { return nmt_ == Nmt::kOperational; }
  void reset(std::int64_t now_ns);
  void network(std::span<const std::uint8_t> payload, std::int64_t now_ns);
  void answer_guard(std::int64_t now_ns);
  void synchronise(std::int64_t now_ns);
  bool set_points(std::span<const std::uint8_t> payload, std::int64_t now_ns);
  void obey(std::int64_t now_ns);
  void lost(std::uint16_t code, std::int64_t now_ns);
  void emergency(std::uint16_t code, std::int64_t now_ns);
  bool is_barred() const;
  void take_sync(bool counts, std::int64_t now_ns);
  void measure();
  void send(CanRole role, std::uint32_t function, std::span<const std::uint8_t> payload,
            std::int64_t now_ns);

  int axis_, node_;
  Cia402Settings settings_;
  CanBus& bus_;
  const Motor& motor_;
  const FaultPlan& faults_;
  ObjectDictionary dictionary_;
  Nmt nmt_ = Nmt::kBoot;
  Cia402State state_ = Cia402State::kSwitchOnDisabled;
  std::uint16_t previous_controlword_ = 0;
  std::array<std::uint8_t, 8> waiting_{};  // set-points that wait for SYNC
  std::size_t waiting_size_ = 0;
  double torque_permille_ = 0.0;
  bool has_tripped_ = false, is_limited_ = false;
  int syncs_ = 0;
  bool guard_toggle_ = false;
  std::int64_t watch_ = 0;  // whom it misses: 1016:01, but for a zero that names no node
  std::vector<std::uint16_t> noted_;
  std::int64_t boot_ns_ = 0, enable_ns_ = 0, heartbeat_ns_ = 0;
  std::int64_t host_ns_ = 0, set_point_ns_ = 0, guard_ns_ = 0, sync_ns_ = 0;  // last heard; 0: no
  bool misses_sync_ = false;
};

}  // namespace tact::rig
