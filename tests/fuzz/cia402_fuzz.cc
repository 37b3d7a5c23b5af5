// SPDX-License-Identifier: Apache-2.0
// CANopen replies are taken from this node alone and whole, and no status leads to a command that a
// drive in that state must not get.
#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/canopen_text.h"
#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_state.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace tact;
using fuzz::require;

void check_state(std::uint16_t statusword, std::uint16_t last) {
  const hal::cia402::Cia402State state = hal::cia402::cia402_state(statusword);
  require(hal::cia402::cia402_state_name(state)[0] != '\0');
  const auto command = hal::cia402::next_controlword(state, last);
  if (state == hal::cia402::Cia402State::kUnknown || state == hal::cia402::Cia402State::kNotReady ||
      state == hal::cia402::Cia402State::kFaultReaction)
    require(!command);
  if (command && *command == hal::cia402::kControlEnable)
    require(state == hal::cia402::Cia402State::kSwitchedOn ||
            state == hal::cia402::Cia402State::kOperationEnabled);
  if (command && *command == hal::cia402::kControlFaultReset)
    require(last != hal::cia402::kControlFaultReset);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto frame = hal::can::unpack_can_frame({data, size});
  if (!frame) return 0;
  const int node = static_cast<int>(frame->id & 0x7F);
  const int other = node == 1 ? 2 : 1;
  if (const auto sdo = hal::cia402::decode_canopen_sdo(*frame, node)) {
    require(!hal::cia402::decode_canopen_sdo(*frame, other));
    require(sdo->size <= 4);
    if (sdo->kind == hal::cia402::SdoReplyKind::kUpload) require(sdo->size <= 4);
    if (sdo->kind == hal::cia402::SdoReplyKind::kAbort)
      require(hal::cia402::sdo_abort_message(sdo->value)[0] != '\0');
  }
  if (const auto emergency = hal::cia402::decode_canopen_emergency(*frame, node)) {
    require(!hal::cia402::decode_canopen_emergency(*frame, other));
    require(hal::cia402::emergency_message(emergency->code)[0] != '\0');
  }
  if (hal::cia402::decode_canopen_heartbeat(*frame, node))
    require(!hal::cia402::decode_canopen_heartbeat(*frame, other));
  if (const auto sample = hal::cia402::decode_cst_sample(*frame, node)) {
    require(!hal::cia402::decode_cst_sample(*frame, other));
    check_state(sample->statusword, frame->data[6]);
  }
  return 0;
}
