// SPDX-License-Identifier: Apache-2.0
// What a moteus says is taken from this drive alone, whole, and never as a number that is none; a
// CAN FD frame reads back as it was written.
#include <cmath>

#include "hal/moteus/moteus_protocol.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tact;
  using fuzz::require;
  const auto frame = hal::can::unpack_can_fd_frame({data, size});
  if (!frame) return 0;
  const auto bytes = hal::can::pack_can_frame(*frame);
  require(bytes && hal::can::unpack_can_fd_frame(*bytes) == frame);
  const auto address = hal::moteus::moteus_address(*frame);
  const auto reply = hal::moteus::decode_moteus(*frame, address.source);
  require(!hal::moteus::decode_moteus(*frame, address.source ^ 1));
  if (!reply) return 0;
  require(address.destination == 0 && frame->id == hal::moteus::moteus_reply_id(address.source));
  for (const auto& value : {reply->position_turns, reply->velocity_turns_per_s, reply->torque_Nm,
                            reply->voltage_V, reply->temperature_C})
    require(!value || std::isfinite(*value));
  for (const auto& value : {reply->mode, reply->fault, reply->home_state})
    require(!value || (*value > -128 && *value < 128));
  return 0;
}
