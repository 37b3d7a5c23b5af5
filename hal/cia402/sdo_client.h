// SPDX-License-Identifier: Apache-2.0
// sdo_client.h - reading and writing the settings of CANopen drives, one at a time, before the
// loop.
//
// Expedited SDO of CiA 301: one request, one reply within 300 ms, or an abort code, which comes
// back in words. Replies to other requests are not taken for ours. Set-up code: blocks.
#pragma once

#include <functional>
#include <optional>

#include "hal/can/can_bus.h"
#include "hal/cia402/canopen_frames.h"
#include "model/result.h"

namespace tact::hal::cia402 {

/// Why a request failed: an abort code, or nothing came.
struct SdoFailure {
  bool silent = false;
  std::uint32_t abort_code = 0;
};

/// What is read, and how many bytes it has: a drive need not say it (0x42).
struct SdoEntry {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint8_t size;  // bytes, 1, 2 or 4
};

class SdoClient {
 public:
  /// Everything that is no reply goes to `others`.
  SdoClient(can::CanBus& bus, std::function<void(const can::CanFrame&)> others)
      : bus_(bus), others_(std::move(others)) {}

  /// Nothing when it is written.
  std::optional<SdoFailure> write(int node, const SdoWrite& what);
  /// The value; a failure in `failure`.
  std::optional<std::uint32_t> read(int node, const SdoEntry& entry, SdoFailure& failure);
  /// Listens only.
  void wait(int time_ms);

 private:
  std::optional<SdoReply> ask(int node, const std::optional<can::CanFrame>& request,
                              std::uint16_t index, std::uint8_t sub);

  can::CanBus& bus_;
  std::function<void(const can::CanFrame&)> others_;
};

/// "refuses setting 0x6060:00: The drive ... (0x06090030)", or that it does not answer.
std::string sdo_failure_text(const SdoFailure& failure, std::uint16_t index, std::uint8_t sub);

}  // namespace tact::hal::cia402
