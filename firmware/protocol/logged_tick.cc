// SPDX-License-Identifier: Apache-2.0
// The one list of a logged tick's fields: member, name with unit, and meaning. Vectors are x, y, z
// in frame W.
#include "firmware/protocol/logged_tick.h"

#include <algorithm>
#include <cstddef>

namespace tact::firmware::protocol {
namespace {

const char* clutch_name(std::uint64_t number) {
  static constexpr std::array kNames{"coupled", "yields", "open"};
  return number < kNames.size() ? kNames[number] : "unknown";
}

#define FIELD(member, meaning) TACT_FIELD(LoggedContact, member, #member, meaning)
constexpr std::array kLoggedContact{
    FIELD(surface_point_m, meaning::kContactPoint), FIELD(depth_m, meaning::kDepth),
    FIELD(state, meaning::kContactState).labelled(contact_state_name)};
#undef FIELD

#define FIELD(member, name, meaning) TACT_FIELD(LoggedTick, member, name, meaning)
#define INPUT(member, name, meaning) FIELD(input.member, name, meaning)
#define OUTPUT(member, name, meaning) FIELD(output.member, name, meaning)
constexpr std::array kTick{
    FIELD(tick, "tick", "number of the tick"),
    FIELD(non_rt, "non_rt", meaning::kNonRt),
    FIELD(due_ns, "due_ns", meaning::kDue),
    FIELD(margin_ns, "margin_ns", "of the tick before: time left to the next deadline"),
    FIELD(phase_ns, "phase_ns", "duration of each phase; publish and total of the tick before")
        .with_components(loop::kPhaseName),
    INPUT(sample.tool.position_m, "tool_position_m", ""),
    INPUT(sample.tool.orientation, "tool_orientation", meaning::kOrientation),
    INPUT(sample.tool.velocity_mps, "tool_velocity_mps", ""),
    INPUT(sample.tool.angular_velocity_radps, "tool_angular_velocity_radps", ""),
    INPUT(sample.tool.grip_ratio, "grip_ratio", meaning::kGrip),
    INPUT(sample.grip_gap_m, "grip_gap_m", "between the fingers of a gripper that can press"),
    INPUT(sample.grip_speed_mps, "grip_speed_mps", "of that gap, opening positive"),
    INPUT(sample.stamp_ns, "sample_stamp_ns", "when the device was read, CLOCK_MONOTONIC"),
    INPUT(sample.sequence, "sample_sequence", "counts the device's samples, never repeats"),
    INPUT(sample.fresh, "sample_fresh", "0: the device had no new sample"),
    INPUT(sample.temperature_C, "temperature_C", meaning::kTemperature),
    INPUT(device_fault, "device_fault", "number of tactd --faults, 0 none").labelled(fault_name),
    INPUT(commands.arm, "command_arm", ""),
    INPUT(commands.stop, "command_stop", ""),
    INPUT(commands.reset, "command_reset", ""),
    INPUT(commands.disarm, "command_disarm", ""),
    INPUT(ready, "ready", "safety lines and device would let a force through"),
    INPUT(clutch, "clutch", "").labelled(clutch_name),
    INPUT(skipped_periods, "skipped_periods", "before this tick"),
    INPUT(clutches, "clutches", "count since start: how often the clutch has opened"),
    INPUT(clutch_shift_m, "clutch_shift_m", "of the tool from the handle"),
    INPUT(variant, "variant",
          "count since start: changes of the law's numbers while it ran; the file has their text"),
    OUTPUT(wanted.force_N, "wanted_force_N", meaning::kWanted),
    OUTPUT(wanted.torque_Nm, "wanted_torque_Nm", meaning::kWanted),
    OUTPUT(written.force_N, "force_N", meaning::kWritten),
    OUTPUT(written.torque_Nm, "torque_Nm", meaning::kWritten),
    OUTPUT(state, "state", "").labelled(state_name),
    OUTPUT(limit, "limit", "last one that acted; number of tactd --faults, 0 none")
        .labelled(fault_name),
    OUTPUT(fault, "fault", meaning::kFault).labelled(fault_name),
    OUTPUT(given_energy_J, "given_energy_J", "net energy given since arming"),
    OUTPUT(rms_force_N, "rms_force_N", meaning::kWrittenRms),
    OUTPUT(contact_losses, "contact_losses", meaning::kContactLosses),
    OUTPUT(wanted_grip_N, "wanted_grip_force_N", "of the law on the fingers, opening positive"),
    OUTPUT(written_grip_N, "grip_force_N", meaning::kWrittenGrip),
    FIELD(utc.offset_ns, "utc_offset_ns", meaning::kUtcOffset),
    FIELD(utc.max_error_us, "utc_max_error_us", meaning::kUtcMaxError),
    FIELD(utc.error_us, "utc_error_us", meaning::kUtcError),
    FIELD(event, "event", "of tactctl, in this tick alone; 0 none"),
    FIELD(event_word, "event_word", "levels of the event lines, event_0 the lowest bit"),
    FIELD(sync, "sync", "level of the sync line, written in this tick"),
    FIELD(contact, "contact", "probe spheres of the tool")};
#undef FIELD
#undef INPUT
#undef OUTPUT

}  // namespace

FieldTable LoggedContact::fields() { return kLoggedContact; }

FieldTable LoggedTick::fields(std::size_t spheres) { return with_contacts<kTick>(spheres); }

LoggedTick LoggedTick::of(const loop::TickRecord& record, bool non_rt, const UtcOffset& utc) {
  LoggedTick out{.tick = record.tick,
                 .non_rt = non_rt,
                 .due_ns = record.due_ns,
                 .margin_ns = record.margin_ns,
                 .phase_ns = record.phase_ns,
                 .input = record.input,
                 .output = record.output,
                 .utc = utc,
                 .event = record.event,
                 .event_word = record.event_word,
                 .sync = record.sync};
  static_assert(kMaxContacts == model::contact::kMaxSpheres);
  std::ranges::transform(
      record.contacts.all(), out.contact, [](const model::contact::SphereContact& from) {
        const model::Vec3& point_m = from.surface_point_m;
        return LoggedContact{
            .surface_point_m = {static_cast<float>(point_m.x), static_cast<float>(point_m.y),
                                static_cast<float>(point_m.z)},
            .depth_m = static_cast<float>(from.depth_m),
            .state = static_cast<ContactState>(from.state)};
      });
  return out;
}

}  // namespace tact::firmware::protocol
