// SPDX-License-Identifier: Apache-2.0
#include "model/fault.h"

#include <algorithm>
#include <array>

namespace tact::model {
namespace {

// Ascending by number. A search from the front is enough: no tick asks for words.
constexpr std::array kTable{
    FaultEntry{Fault::kNone, "none", "nothing limits the force", "nothing to do"},
    FaultEntry{Fault::kSampleHeld, "sample held", "the device gave no new sample this tick",
               "harmless when rare; if it repeats, check cable, hub and bus load"},
    FaultEntry{Fault::kSampleStale, "sample stale",
               "two or more samples in a row are missing; the force ramps down to zero",
               "check cable, hub and bus load"},
    FaultEntry{Fault::kNotArmed, "not armed", "the controller is not armed, the force is zero",
               "a simulated device arms by itself once its samples are good; hold a real one, then "
               "tactctl SCENE arm"},
    FaultEntry{Fault::kOutsideWorkspace, "outside workspace",
               "the tool left the permitted workspace, the force ramps down to zero",
               "bring the tool back, or widen limits.workspace_* in the scene"},
    FaultEntry{Fault::kForceLimited, "force limited", "the wanted force is above limits.force_N",
               "press less, or soften the law in the scene"},
    FaultEntry{Fault::kTorqueLimited, "torque limited",
               "the wanted torque is above limits.torque_Nm", "shorten the tool's lever arm"},
    FaultEntry{Fault::kSlewLimited, "slew limited",
               "the force changes faster than limits.slew_N_per_s",
               "harmless at a tear or a release; if it stays, soften the law"},
    FaultEntry{Fault::kRampingUp, "ramping up", "the force ramps up after arming",
               "wait for limits.ramp_s"},
    FaultEntry{
        Fault::kLawSaturated, "beyond the law",
        "the tissue is pressed or pulled beyond what its law answers: the force stays at its "
        "limit, or follows slowly where it would jump",
        "press less, or give the law more range in the scene"},
    FaultEntry{
        Fault::kTooFast, "too fast",
        "the tool is faster than limits.speed_mps or turn_radps, the force ramps down to zero",
        "move slower, or raise the limit in the scene"},
    FaultEntry{Fault::kEnergyLimited, "energy limited",
               "the device has given its energy budget to the hand; the force is damped",
               "soften the law, raise rate_Hz or take a device with more damping; a larger "
               "limits.energy_J lets it shake more"},
    FaultEntry{Fault::kContinuousLimited, "continuous limited",
               "the RMS of the force nears limits.continuous_force_N",
               "press less or rest; the motors bear their peak for a while only"},
    FaultEntry{Fault::kPowerLimited, "power limited",
               "force times speed of the tool nears limits.power_W",
               "let the tool go back slower, or soften the law"},
    FaultEntry{
        Fault::kToolInside, "inside the organ",
        "the tool was found inside the organ: no contact and no force until it has once been "
        "outside",
        "take it out of the organ"},
    FaultEntry{
        Fault::kContactLost, "contact lost",
        "while samples were missing the tool moved farther than limits.speed_mps allows; contact "
        "ends, held tissue is released",
        "check for lost samples and long pauses"},
    FaultEntry{
        Fault::kClutchPressed, "clutch pressed",
        "the tool stays where it is, without a force, while the handle moves; held tissue is "
        "released",
        "release the clutch: contact begins again where the tool is. If it is not pressed, its "
        "line "
        "flaps: repair it (device.lines.clutch)"},
    FaultEntry{Fault::kUnknown, "unknown", "a fault of another version of tact, or a broken record",
               "use programs and recordings of one build"},
    FaultEntry{Fault::kForceNotFinite, "force not finite", "the model produced NaN or infinity",
               "report it with the recording; check the scene's parameters"},
    FaultEntry{Fault::kSampleNotFinite, "sample not finite", "the device reported NaN or infinity",
               "restart the device; if it repeats, its encoders or driver are broken"},
    FaultEntry{Fault::kDeviceLost, "device lost", "20 samples in a row are missing",
               "check power and cable, then start tactd again"},
    FaultEntry{Fault::kDeviceFailed, "device failed", "the device reported an error",
               "check power, cable and driver of the device, then start tactd again"},
    FaultEntry{Fault::kLoopLate, "loop late",
               "overrun: 20 periods skipped (0.3 s on a stock kernel), or 20 late ticks in a row "
               "(100 on a "
               "stock kernel); or the PC was suspended",
               "use a faster law (tact-lab plan names one) or a lower rate_Hz, and free the loop's "
               "core of other work, then start tactd again"},
    FaultEntry{Fault::kLawBroke, "law broke",
               "the tissue's law blew up and gives no force that can be trusted",
               "make its step shorter or its springs softer (spring_patch.substeps, integrator), "
               "then start tactd again"},
    FaultEntry{Fault::kEmergencyStop, "emergency stop", "a channel of the e-stop is open",
               "make sure that no person is in danger, release the e-stop, then reset and arm"},
    FaultEntry{Fault::kLinesDiffer, "lines differ",
               "the two channels of the e-stop disagreed for more than 50 ms",
               "a wire, contact or input is broken: repair it before anybody holds the device"},
    FaultEntry{Fault::kLinesLost, "lines lost", "the chip of the safety lines does not answer",
               "check the chip and its driver (dmesg), then start tactd again"},
    FaultEntry{Fault::kDeadManReleased, "dead man released", "the dead-man switch is open",
               "hold it, then reset and arm"},
    FaultEntry{
        Fault::kBusDown, "bus down", "the CAN interface went down or takes no frames",
        "check adapter, cable and termination, then start tactd again: it says how to bring the "
        "interface up"},
    FaultEntry{
        Fault::kBusOff, "bus off", "the CAN controller is error passive, or has left the bus",
        "check bit rate, termination and cable, then start tactd again: it says how to set the "
        "interface up again"},
    FaultEntry{Fault::kDriveFault, "drive fault", "a drive reported an error",
               "the message after it says which and why; repair the cause, then start tactd again"},
    FaultEntry{Fault::kDriveSilent, "drive silent", "a drive's heartbeat is missing",
               "check its supply and its cable, then start tactd again"},
    FaultEntry{Fault::kDeviceUnplugged, "device unplugged", "the USB device is gone",
               "plug it in again, then start tactd again"},
    FaultEntry{Fault::kDeviceGarbled, "device garbled",
               "what the device sends cannot be understood, or repeats old samples",
               "check cable and hub and keep other traffic off its bus, then start tactd again"},
    FaultEntry{Fault::kHomingLost, "homing lost", "the device no longer knows where it is",
               "start tactd again and home it"},
    FaultEntry{Fault::kForceOff, "force off", "the device itself switched its forces off",
               "the message after it says why; repair the cause, then start tactd again"},
    FaultEntry{Fault::kPowerLost, "power lost",
               "the motors lost their power while armed: the enable line fell, as after a pause of "
               "the heartbeat, or the device switched them off",
               "find out why (late ticks, enable line, supply), then reset and arm"},
    FaultEntry{Fault::kLoopStalled, "loop stalled",
               "no tick for 20 periods, 250 ms without hard real time: the loop hangs, or has lost "
               "its core",
               "free the loop's core of other work, then start tactd again; if it repeats, report "
               "it with the black box"},
    FaultEntry{
        Fault::kDeviceStalled, "device stalled",
        "a call to the device did not come back for 20 periods, 250 ms without hard real time",
        "check power, cable and driver of the device (dmesg), then start tactd again"},
    FaultEntry{Fault::kLoopRanAway, "loop ran away",
               "a real-time thread kept its core for 50 ms without sleeping",
               "report it with the black box, then start tactd again"},
    FaultEntry{Fault::kForbiddenCall, "forbidden call",
               "the loop made a system call that its device does not list",
               "report it with the black box; --no-seccomp runs without this check"},
    FaultEntry{Fault::kGuardianLost, "guardian lost",
               "tact-guardian, the process that zeroes the device if tactd dies, has ended",
               "find out who ended it (dmesg), then start tactd again"},
    FaultEntry{Fault::kGripFlaps, "grip flaps",
               "the line of the grip switch changed faster than a foot or a hand can",
               "repair the switch or its wire (device.lines.grip), then reset and arm"},
    FaultEntry{Fault::kForeignCommand, "foreign command",
               "another program or computer commands the drives on this bus",
               "end it or take it off the bus (candump shows what it sends), then start tactd "
               "again"},
    FaultEntry{Fault::kEnergyOverdrawn, "energy overdrawn",
               "the device gave more energy to the hand than limits.energy_J: the tool jumped, or "
               "the loop paused, under force",
               "check for lost samples and late ticks, then reset and arm"},
    FaultEntry{Fault::kPowerExceeded, "power exceeded",
               "the tool sped up so fast under force that its power passed limits.power_W",
               "hold the tool firmly, then reset and arm; raise limits.power_W if hands move so "
               "fast"},
};

}  // namespace

std::span<const FaultEntry> fault_table() { return kTable; }

const FaultEntry& describe(Fault fault) {
  const auto* const entry = std::ranges::find(kTable, fault, &FaultEntry::fault);
  return entry != kTable.end() ? *entry : describe(Fault::kUnknown);
}

}  // namespace tact::model
