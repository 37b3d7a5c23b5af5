// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/canopen_text.h"

namespace tact::hal::cia402 {
namespace {

constexpr std::uint32_t kExact = 0xFFFFFFFF, kFamily = 0xFF00, kGroup = 0xF000;

// The first entry that fits is reported: a group before its exact codes would hide them.
constexpr CanopenText kEmergencyTexts[] = {
    {0x3210, kExact, "DC bus voltage too high: brake more gently or fit a brake resistor."},
    {0x3220, kExact, "DC bus voltage too low: is the drive's supply on?"},
    {0x4210, kExact, "The drive is too hot: let it cool and check its cooling."},
    {0x4310, kExact, "The drive is too hot: let it cool and check its cooling."},
    {0x7305, kExact, "The position sensor failed: check the encoder's cable and supply."},
    {0x8110, kExact, "The drive lost CAN frames: fewer frames per cycle, or a longer cycle."},
    {0x8120, kExact,
     "The drive sees many errors on the CAN bus: check cable, termination and bit rate."},
    {0x8130, kExact,
     "The drive missed the controller's heartbeat and stopped: check the CAN cable, and that the "
     "controller runs."},
    {0x8140, kExact,
     "The drive had left the CAN bus after errors: check the cable, then start again."},
    {0x8150, kExact, "Two devices use the same CAN identifier: give every drive its own node."},
    {0x8210, kExact, "A command had the wrong length for the drive: write its mapping again."},
    {0x8220, kExact, "A command was too long for the drive: write its mapping again."},
    {0x8250, kExact,
     "No command reached the drive in time: check the CAN cable, and that the controller runs."},
    {0x8611, kExact, "The motor did not follow its position: is the joint blocked?"},
    {0x0000, kExact, "The drive reports that its errors are gone."},
    {0x2300, kFamily,
     "Too much motor current: check the motor cables for a short, then lower the force limit."},
    {0x8100, kFamily, "The drive has trouble on the CAN bus: check cable, termination, bit rate."},
    {0x8200, kFamily, "The drive did not understand a frame: write its mapping again."},
    {0x8300, kFamily, "The torque control met its limit: check the torque limits of the drive."},
    {0x8400, kFamily, "The motor turned too fast or not as commanded: move more slowly."},
    {0x8500, kFamily, "The position control stopped: bring the arm back into its range by hand."},
    {0x1000, kGroup, "The drive reports an error without saying which: look it up in its manual."},
    {0x2000, kGroup, "The drive's current is wrong: check the motor cables and the supply."},
    {0x3000, kGroup, "The drive's voltage is wrong: check its supply."},
    {0x4000, kGroup, "A temperature is too high: let motor and drive cool."},
    {0x5000, kGroup, "The drive's hardware failed: switch it off and on, then have it repaired."},
    {0x6000, kGroup, "The drive's software or settings are damaged: load its settings again."},
    {0x7000, kGroup,
     "A part at the drive failed, such as encoder or brake: check its cable and supply."},
    {0x8000, kGroup, "The drive's monitoring stopped it: look its code up in the manual."},
    {0x9000, kGroup, "Something outside stopped the drive: check its safety and limit inputs."},
    {0xF000, kGroup, "An error that the vendor of the drive defines: look it up in its manual."},
    {0, 0, "An error that no standard names: look it up in the drive's manual."},
};

// CiA 301's abort codes of SDO.
constexpr CanopenText kAbort[] = {
    {0x05030000, kExact, "Request and reply got out of step: try again."},
    {0x05040000, kExact, "The drive did not answer in time: is it on, and at this node?"},
    {0x05040001, kExact, "The drive does not know this kind of request: update its firmware."},
    {0x05040005, kExact, "The drive has no memory left: restart it."},
    {0x06010000, kExact, "This setting cannot be reached in this way: see the drive's manual."},
    {0x06010001, kExact, "This setting can only be written."},
    {0x06010002, kExact,
     "This setting can only be read: update the drive's firmware, or take another drive."},
    {0x06020000, kExact, "The drive does not have this setting: is it the right drive?"},
    {0x06040041, kExact,
     "The drive cannot send or take this value every cycle: update its firmware, or take another "
     "drive."},
    {0x06040042, kExact,
     "The drive sends fewer values a cycle than three: update its firmware, or take another "
     "drive."},
    {0x06040043, kExact, "Settings contradict each other: see the drive's manual."},
    {0x06040047, kExact, "The drive cannot combine these settings: see its manual."},
    {0x06060000, kExact, "The drive's memory failed: restart it, then have it repaired."},
    {0x06070010, kExact, "The setting has another length in this drive: is it the right drive?"},
    {0x06070012, kExact, "The value is too long for this setting: is it the right drive?"},
    {0x06070013, kExact, "The value is too short for this setting: is it the right drive?"},
    {0x06090011, kExact,
     "The drive does not have this part of the setting: is it the right drive?"},
    {0x06090030, kExact, "The value is outside what the drive permits: see its manual."},
    {0x06090031, kExact, "The value is too high for the drive: see its manual."},
    {0x06090032, kExact, "The value is too low for the drive: see its manual."},
    {0x06090036, kExact, "The largest value is below the smallest: correct the settings."},
    {0x060A0023, kExact, "The drive has no room for this: see its manual."},
    {0x08000000, kExact, "The drive refused without a reason: restart it and try again."},
    {0x08000020, kExact, "The drive cannot store this value: restart it and try again."},
    {0x08000021, kExact, "The drive is under local control: close its vendor's program."},
    {0x08000022, kExact, "The drive does not take this in its present state: switch it off first."},
    {0x08000023, kExact, "The drive's list of settings is damaged: load its firmware again."},
    {0x08000024, kExact, "The drive has no data for this: see its manual."},
    {0, 0, "The drive refused for a reason that no standard names: see its manual."},
};

const char* message_of(std::uint32_t code, std::span<const CanopenText> words) RT_SAFE {
  for (const CanopenText& one : words)  // bound: words of the table
    if ((code & one.mask) == one.code) return one.message;
  // Never reached, as the last entry has mask 0; the compiler cannot know.
  return words.back().message;
}

}  // namespace

std::span<const CanopenText> emergency_texts() RT_SAFE { return kEmergencyTexts; }
std::span<const CanopenText> sdo_abort_texts() RT_SAFE { return kAbort; }

const char* emergency_message(std::uint16_t code) RT_SAFE {
  return message_of(code, kEmergencyTexts);
}
const char* sdo_abort_message(std::uint32_t code) RT_SAFE { return message_of(code, kAbort); }

const char* nmt_message(NmtState state) {
  switch (state) {
    case NmtState::kBoot:
      return "the drive restarted by itself: check its supply";
    case NmtState::kStopped:
      return "the drive was stopped over the bus: is a second controller on it?";
    case NmtState::kPreOperational:
      return "the drive went pre-operational: it lost the controller's heartbeat or had bus "
             "errors, or a second controller is on the bus";
    case NmtState::kOperational:
      break;
  }
  return "the drive left its normal state on the bus";
}

}  // namespace tact::hal::cia402
