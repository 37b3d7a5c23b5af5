// CANopen replies are taken from this node alone and whole, and no status leads to a command that a
// drive in that state must not get.
#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/canopen_words.h"
#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_state.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace tact;
using fuzz::require;

void check_state(std::uint16_t statusword, std::uint16_t last) {
  const hal::Cia402State state = hal::cia402_state(statusword);
  require(hal::cia402_state_name(state)[0] != '\0');
  const auto command = hal::next_controlword(state, last);
  if (state == hal::Cia402State::kUnknown || state == hal::Cia402State::kNotReady ||
      state == hal::Cia402State::kFaultReaction)
    require(!command);
  if (command && *command == hal::kControlEnable)
    require(state == hal::Cia402State::kSwitchedOn || state == hal::Cia402State::kOperationEnabled);
  if (command && *command == hal::kControlFaultReset) require(last != hal::kControlFaultReset);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto frame = hal::unpack_can_frame({data, size});
  if (!frame) return 0;
  const int node = static_cast<int>(frame->id & 0x7F);
  const int other = node == 1 ? 2 : 1;
  if (const auto sdo = hal::decode_canopen_sdo(*frame, node)) {
    require(!hal::decode_canopen_sdo(*frame, other));
    require(sdo->size <= 4);
    if (sdo->kind == hal::SdoReplyKind::kUpload) require(sdo->size >= 1);
    if (sdo->kind == hal::SdoReplyKind::kAbort)
      require(hal::sdo_abort_sentence(sdo->value)[0] != '\0');
  }
  if (const auto emergency = hal::decode_canopen_emergency(*frame, node)) {
    require(!hal::decode_canopen_emergency(*frame, other));
    require(hal::emergency_sentence(emergency->code)[0] != '\0');
  }
  if (hal::decode_canopen_heartbeat(*frame, node))
    require(!hal::decode_canopen_heartbeat(*frame, other));
  if (const auto sample = hal::decode_cst_sample(*frame, node)) {
    require(!hal::decode_cst_sample(*frame, other));
    check_state(sample->statusword, frame->data[6]);
  }
  return 0;
}
