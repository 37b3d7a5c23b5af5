// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_listener.h"

#include <fmt/core.h>

#include <algorithm>

#include "hal/can/can_delta.h"
#include "model/time_ns.h"

namespace tact::hal::odrive {
namespace {

constexpr int kFeed_ms = 5;

}  // namespace

OdriveTorqueLength odrive_torque_length(const OdriveSettings& settings) {
  return settings.short_torque ? OdriveTorqueLength::kShort : OdriveTorqueLength::kPadded;
}

OdriveListener::OdriveListener(can::CanBus& bus, const model::DeviceSettings& settings)
    : bus_(bus),
      can_(settings.of<can::CanSettings>()),
      torque_length_(odrive_torque_length(settings.of<OdriveSettings>())) {
  for (std::size_t i = 0; i < 3; ++i) axes[i].node = can_.node[i];
}

bool OdriveListener::run_until(const Condition& fits, int time_ms) {
  can::CanSocket& socket = bus_.socket();
  const std::int64_t end_ns = socket.now_ns() + time_ms * model::kMillisecond_ns;
  while (bus_.fault() == Fault::kNone) {
    for (const can::CanReceived& one : bus_.receive())
      take(one.frame, socket.now_ns() - one.age_ns);
    if (std::all_of(axes.begin(), axes.end(), fits)) return true;
    const std::int64_t now_ns = socket.now_ns();
    if (now_ns >= end_ns) return false;
    if (now_ns >= feed_ns_) {
      feed_ns_ = now_ns + kFeed_ms * model::kMillisecond_ns;
      each([this](int node) { return odrive_input_torque(node, 0.0, torque_length_); });
    }
    socket.wait(kFeed_ms);
  }
  return false;
}

std::optional<model::Error> OdriveListener::wrong(const Condition& fits, const char* words) const {
  for (std::size_t i = 0; i < 3; ++i)
    if (fits(axes[i])) return model::Error{fmt::format("{} {}", can::can_arm_name(i, can_), words)};
  return std::nullopt;
}

void OdriveListener::take(const can::CanFrame& frame, std::int64_t arrival_ns) {
  for (OdriveHeard& axis : axes) {
    if (const auto beat = decode_odrive_heartbeat(frame, axis.node)) {
      if (axis.beat_ns != 0)
        axis.longest_beat_ns = std::max(axis.longest_beat_ns, arrival_ns - axis.beat_ns);
      axis.beat_ns = arrival_ns;
      take_heartbeat(axis, frame, *beat);
    } else if (const auto version = decode_odrive_version(frame, axis.node)) {
      axis.version = *version;
    } else if (const auto count = decode_odrive_count_05(frame, axis.node)) {
      axis.shadow_count = count->shadow;
    } else if (const auto at = decode_odrive_estimates(frame, axis.node)) {
      const bool first = axis.positions++ == 0;
      axis.at_turns = at->position_turns;
      axis.all_zero = axis.all_zero && at->position_turns == 0.0 && at->velocity_turns_per_s == 0.0;
      axis.least_turns = first ? axis.at_turns : std::min(axis.least_turns, axis.at_turns);
      axis.most_turns = first ? axis.at_turns : std::max(axis.most_turns, axis.at_turns);
    }
  }
}

void OdriveListener::take_heartbeat(OdriveHeard& axis, const can::CanFrame& frame,
                                    const OdriveHeartbeat& beat) {
  ++axis.heartbeats;
  axis.error = beat.axis_error;
  axis.state = beat.axis_state;
  axis.result = beat.procedure_result;
  axis.searched = axis.searched || axis.is_in(OdriveAxisState::kIndexSearch);
  const auto beat05 = decode_odrive_heartbeat_05(frame, axis.node);
  axis.parts = generation == OdriveGeneration::k05 && beat05 ? odrive_parts_05(*beat05) : 0;
}

}  // namespace tact::hal::odrive
