// SPDX-License-Identifier: Apache-2.0
// The one list of a frame's fields: name with unit, and meaning. Vectors are x, y, z in frame W.
#include "firmware/protocol/frame.h"

#include <cstddef>

namespace tact::firmware::protocol {
namespace {

#define FIELD(member, meaning) TACT_FIELD(FrameContact, member, #member, meaning)
constexpr std::array kContact{
    FIELD(surface_point_m, meaning::kContactPoint),
    FIELD(normal, "outward unit normal there"),
    FIELD(shift_m, "tangential displacement of the tissue"),
    FIELD(depth_m, meaning::kDepth),
    FIELD(profile_m,
          "displacement into the tissue at radius j profile_pitch_m; profile_points are in use"),
    FIELD(tilt, "m/m; added to the profile at x: tilt . (x - surface_point_m)"),
    FIELD(state, meaning::kContactState).labelled(contact_state_name)};
#undef FIELD

#define FIELD(member, meaning) TACT_FIELD(FramePatch, member, #member, meaning)
constexpr std::array kPatch{FIELD(vertex_count, "displaced vertices in this frame"),
                            FIELD(cut_total, "triangles cut so far"),
                            FIELD(cut_first, "index in that list of the first one here"),
                            FIELD(cut_count, "cut triangles in this frame"),
                            FIELD(vertex, "of the organ's mesh; vertex_count are in use"),
                            FIELD(cut_triangle, "of the organ's mesh; cut_count are in use"),
                            FIELD(displacement_um, "from rest; vertex_count are in use")};
#undef FIELD

/// kBound_us as text; the last bucket has no bound.
constexpr std::array kBound_names{"1us",   "2us",   "5us",   "10us",   "20us",   "50us",
                                  "100us", "200us", "500us", "1000us", "5000us", "inf"};
static_assert(kBound_names.size() == FrameDurations::kBound_us.size() + 1);

#define FIELD(member, meaning) TACT_FIELD(FrameDurations, member, #member, meaning)
constexpr std::array kDurations{
    FIELD(ticks, "count since start; a tick counts at the least bound that it keeps")
        .with_components(kBound_names),
    FIELD(sum_ns, "of those ticks")};
#undef FIELD

#define FIELD(member, meaning) TACT_FIELD(FrameEvent, member, #member, meaning)
constexpr std::array kEvent{FIELD(number, "0: none yet"),
                            FIELD(due_ns, "deadline of its tick, CLOCK_MONOTONIC")};
#undef FIELD

#define FIELD(member, meaning) TACT_FIELD(Frame, member, #member, meaning)
constexpr std::array kFrame{
    FIELD(tick, "number of the newest tick"),
    FIELD(time_ns, "since the loop started"),
    FIELD(due_ns, meaning::kDue),
    TACT_FIELD(Frame, utc.offset_ns, "utc_offset_ns", meaning::kUtcOffset),
    TACT_FIELD(Frame, utc.max_error_us, "utc_max_error_us", meaning::kUtcMaxError),
    TACT_FIELD(Frame, utc.error_us, "utc_error_us", meaning::kUtcError),
    FIELD(late_ticks, "count since start"),
    FIELD(skipped_ticks, "count since start"),
    FIELD(dropped_records, "count since start"),
    FIELD(tool_position_m, ""),
    FIELD(tool_orientation, meaning::kOrientation).with_components(kWxyz),
    FIELD(tool_velocity_mps, ""),
    FIELD(grip_ratio, meaning::kGrip),
    FIELD(force_N, meaning::kWritten),
    FIELD(torque_Nm, meaning::kWritten),
    FIELD(wanted_force_N, meaning::kWanted),
    FIELD(worst_margin_us, "least time left before a deadline since the last frame"),
    FIELD(median_tick_us, "duration of the ticks since the last frame"),
    FIELD(peak_force_N, "largest magnitude since the last frame"),
    FIELD(rms_force_N, meaning::kWrittenRms),
    FIELD(given_energy_J, "net energy given since arming; largest since the last frame"),
    FIELD(grip_force_N, meaning::kWrittenGrip),
    FIELD(fault, meaning::kFault).labelled(fault_name),
    FIELD(limit, "last one that acted since the last frame; number of tactd --faults, 0 none")
        .labelled(fault_name),
    FIELD(state, "").labelled(state_name),
    FIELD(non_rt, meaning::kNonRt),
    FIELD(contact_losses, meaning::kContactLosses),
    FIELD(temperature_C, meaning::kTemperature),
    FIELD(wake, "ticks by wake-up latency"),
    FIELD(duration, "ticks by duration, without the newest"),
    FIELD(event, "newest one of tactctl"),
    FIELD(contact, "probe spheres of the tool; as many as the head has spheres are in use"),
    FIELD(patch, "of a mass-spring law")};
#undef FIELD

}  // namespace

FieldTable FrameContact::fields() { return kContact; }
FieldTable FramePatch::fields() { return kPatch; }
FieldTable FrameEvent::fields() { return kEvent; }
FieldTable FrameDurations::fields() { return kDurations; }

void FrameDurations::add(std::int64_t duration_ns) {
  std::size_t i = 0;
  while (i < kBound_us.size() && duration_ns > 1000 * std::int64_t{kBound_us[i]}) ++i;
  ++ticks[i];
  sum_ns += static_cast<std::uint64_t>(duration_ns);
}

FieldTable Frame::fields(std::size_t spheres) { return with_contacts<kFrame>(spheres); }

}  // namespace tact::firmware::protocol
