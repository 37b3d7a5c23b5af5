// SPDX-License-Identifier: Apache-2.0
// cia402_network.h - three drives as nodes of the bus: found, started, and reset where one stays
// out.
//
//     find_all   NMT pre-operational, device type (1000) of each
//     start_all  NMT start; heartbeats say operational
//     reset_idle NMT reset communication for those that do not; until they say that they booted
//
// CiA 301 leaves it to a node whether it becomes operational while it notes an error of the bus:
// CANopenNode does not (CN-7). Such an error outlives the host that caused it, and often nothing
// but a reset of the node's communication ends it. Set-up code: blocks.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "hal/can/can_bus.h"
#include "hal/can/can_settings.h"
#include "hal/cia402/sdo_client.h"
#include "model/result.h"

namespace tact::hal::cia402 {

class Cia402Network {
 public:
  Cia402Network(can::CanBus& bus, const can::CanSettings& can)
      : bus_(bus), can_(can), sdo_(bus, [this](const can::CanFrame& frame) { take(frame); }) {}

  SdoClient& sdo() { return sdo_; }
  /// What is wrong with a drive, or with the bus, if that failed.
  model::Error wrong(std::size_t i, const std::string& words) const;

  /// In pre-operational no PDO flows: a drive that an earlier run left alive takes no torque.
  std::optional<model::Error> find_all();
  /// True: all three have said that they are operational.
  bool start_all();
  /// Those that have not: the settings of the bus as after power-on, without old errors.
  void reset_idle();
  /// Names the first that has not, and why, as far as it says.
  model::Error not_started();

 private:
  bool is_operational(std::size_t i) const { return said_[i] == NmtState::kOperational; }
  void take(const can::CanFrame& frame);

  can::CanBus& bus_;
  const can::CanSettings& can_;
  std::array<std::optional<NmtState>, 3> said_{};  // by the last heartbeat since asked
  std::array<bool, 3> booted_{};                   // since the reset
  SdoClient sdo_;
};

}  // namespace tact::hal::cia402
