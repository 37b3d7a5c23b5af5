// SPDX-License-Identifier: Apache-2.0
// A frame from the kernel is taken whole or not at all, and comes out as it went in.
#include "hal/can/can_error.h"
#include "hal/can/can_frame.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tact;
  using fuzz::require;
  const fuzz::Bytes input(data, size);
  const auto frame = hal::can::unpack_can_frame(input);
  const auto error = hal::can::decode_can_error(input);
  require(!(frame && error));
  if (frame) {
    require(frame->id <= hal::can::kCanLargestId && frame->length <= 8);
    require(frame->payload().size() <= frame->length);
    const auto packed = hal::can::pack_can_frame(*frame);
    require(packed.has_value());
    require(hal::can::unpack_can_frame(*packed) == frame);
  }
  if (error) require(error->classes != 0 && error->text()[0] != '\0');
  return 0;
}
