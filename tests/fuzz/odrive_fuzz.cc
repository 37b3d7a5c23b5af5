// SPDX-License-Identifier: Apache-2.0
// What a drive says is taken from this drive alone, whole, and never as a number that is none.
#include <cmath>

#include "hal/odrive/odrive_errors.h"
#include "hal/odrive/odrive_protocol.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace tact;
using fuzz::require;

/// The decoder's answer, and none for the neighbour's node.
template <typename Decode>
auto from_one_drive(Decode decode, const hal::can::CanFrame& frame, int node) {
  const auto heard = decode(frame, node);
  if (heard) require(!frame.rtr && hal::odrive::odrive_address(frame).node == node);
  require(!decode(frame, node ^ 1));
  return heard;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto frame = hal::can::unpack_can_frame({data, size});
  if (!frame) return 0;
  const int node = hal::odrive::odrive_address(*frame).node;
  require(node >= 0 && node <= hal::odrive::kOdriveLargestNode);
  if (const auto e = from_one_drive(hal::odrive::decode_odrive_estimates, *frame, node))
    require(std::isfinite(e->position_turns) && std::isfinite(e->velocity_turns_per_s));
  if (const auto h = from_one_drive(hal::odrive::decode_odrive_heartbeat, *frame, node))
    require((h->axis_error == 0) == (hal::odrive::first_odrive_error(h->axis_error) == nullptr));
  if (const auto h = from_one_drive(hal::odrive::decode_odrive_heartbeat_05, *frame, node))
    require((h->axis_error == 0) == (hal::odrive::first_odrive_error_05(h->axis_error) == nullptr));
  from_one_drive(hal::odrive::decode_odrive_version, *frame, node);
  return 0;
}
