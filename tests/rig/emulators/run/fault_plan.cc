// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/run/fault_plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace tact::rig {
namespace {

constexpr double kForceThreshold_N = 0.05;
constexpr double kForEver_ms = 1e9, kOnce_ms = 0.0;

struct Kind {
  std::string_view name;
  FaultKind kind;
  FaultSide side;
  double duration_ms;  // unless the order says another
};
constexpr Kind kKinds[] = {
    {"lost", FaultKind::kLost, FaultSide::kDrives, 100.0},
    {"duplicated", FaultKind::kDuplicated, FaultSide::kDrives, 1000.0},
    {"reordered", FaultKind::kReordered, FaultSide::kDrives, 1000.0},
    {"stale", FaultKind::kStale, FaultSide::kDrives, 100.0},
    {"wrong-node", FaultKind::kWrongNode, FaultSide::kDrives, 100.0},
    {"drive-fault", FaultKind::kDriveFault, FaultSide::kDrives, kOnce_ms},
    {"emcy", FaultKind::kEmcy, FaultSide::kDrives, kOnce_ms},
    {"heartbeat-missing", FaultKind::kHeartbeatMissing, FaultSide::kDrives, kForEver_ms},
    {"silent", FaultKind::kSilent, FaultSide::kDrives, kForEver_ms},
    {"garbage", FaultKind::kGarbage, FaultSide::kBoth, 100.0},
    {"bus-off-frame", FaultKind::kBusOffFrame, FaultSide::kDrives, kOnce_ms},
    {"error-passive-frame", FaultKind::kErrorPassiveFrame, FaultSide::kDrives, kOnce_ms},
    {"no-ack-frame", FaultKind::kNoAckFrame, FaultSide::kDrives, kOnce_ms},
    {"unpowered", FaultKind::kUnpowered, FaultSide::kBoth, kForEver_ms},
    {"unplug", FaultKind::kUnplug, FaultSide::kFalcon, kOnce_ms},
    {"stall", FaultKind::kStall, FaultSide::kFalcon, kOnce_ms},
    {"short", FaultKind::kShort, FaultSide::kFalcon, kOnce_ms},
    {"no-reply", FaultKind::kNoReply, FaultSide::kFalcon, 30.0},
    {"duplicate", FaultKind::kDuplicate, FaultSide::kFalcon, 100.0},
};

bool serves(const Kind& kind, FaultSide side) {
  return (static_cast<unsigned>(kind.side) & static_cast<unsigned>(side)) != 0;
}
bool number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value) &&
         value >= 0.0 && value <= kForEver_ms;
}
std::int64_t ns_of_ms(double ms) { return std::llround(ms * 1e6); }
/// Cut `text` at `mark`; what follows it, if the mark is there.
std::optional<std::string_view> cut(std::string_view& text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view tail = text.substr(at + 1);
  text = text.substr(0, at);
  return tail;
}

}  // namespace

std::string fault_names(FaultSide side) {
  std::string names;
  for (const Kind& kind : kKinds) {
    if (!serves(kind, side)) continue;
    if (!names.empty()) names += ", ";
    names += kind.name;
  }
  return names;
}

bool parse_fault(std::string_view text, FaultSide side, Fault& fault, std::string& error) {
  std::string_view name = text;
  std::string_view at = cut(name, '@').value_or("");
  const auto duration = cut(at, '+'), axis = cut(name, ':');
  error = "--fault " + std::string(text) + ": ";
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) {
    return k.name == name && serves(k, side);
  });
  if (kind == std::end(kKinds)) {
    error += "no such kind; one of " + fault_names(side);
    return false;
  }
  double seconds = 0.0, ms = kind->duration_ms, numbered = 0.0;
  if (!number(at, seconds) || (duration && !number(*duration, ms))) {
    error += "write KIND[:NUMBER]@SECONDS[+DURATION_MS], as drive-fault:2@2.2 or lost@2.2+30";
    return false;
  }
  const bool in_ms = kind->kind == FaultKind::kNoReply;
  if (axis && (!number(*axis, numbered) ||
               (!in_ms && numbered != 1.0 && numbered != 2.0 && numbered != 3.0))) {
    error += in_ms ? "write no-reply:MILLISECONDS@SECONDS" : "the axis is 1, 2 or 3";
    return false;
  }
  fault = {.kind = kind->kind, .text = std::string(text)};
  if (in_ms && axis) ms = numbered;
  if (!in_ms && axis) fault.axis = static_cast<int>(numbered) - 1;
  fault.at_ns = ns_of_ms(1000.0 * seconds);
  fault.duration_ns = ns_of_ms(ms);
  error.clear();
  return true;
}

void FaultPlan::start(std::int64_t now_ns) {
  if (start_ns_ == 0) start_ns_ = now_ns;
}

void FaultPlan::tick(std::int64_t now_ns) {
  for (Fault& fault : faults_) {
    // Without power there is no first enable to count from.
    if (fault.kind == FaultKind::kUnpowered && fault.at_ns == 0 && fault.injected_ns == 0)
      fault.injected_ns = now_ns;
    if (start_ns_ != 0 && fault.injected_ns == 0 && now_ns >= start_ns_ + fault.at_ns)
      fault.injected_ns = now_ns;
  }
}

bool FaultPlan::is_on(const Fault& fault, FaultKind kind, int axis, std::int64_t now_ns) const {
  return fault.kind == kind && fault.injected_ns != 0 && now_ns >= fault.injected_ns &&
         (axis < 0 || fault.axis < 0 || fault.axis == axis);
}

bool FaultPlan::active(FaultKind kind, int axis, std::int64_t now_ns) const {
  for (const Fault& fault : faults_) {
    if (!is_on(fault, kind, axis, now_ns)) continue;
    if (now_ns >= fault.injected_ns + fault.duration_ns) continue;
    ++fault.acts;
    return true;
  }
  return false;
}

bool FaultPlan::once(FaultKind kind, int axis, std::int64_t now_ns) {
  for (Fault& fault : faults_) {
    bool& seen = fault.seen[axis < 0 ? 0u : static_cast<unsigned>(axis)];
    if (seen || !is_on(fault, kind, axis, now_ns)) continue;
    seen = true;
    ++fault.acts;
    return true;
  }
  return false;
}

void FaultPlan::watch(double force_N, bool torque_is_zero, std::int64_t now_ns) {
  for (Fault& fault : faults_) {
    if (fault.injected_ns == 0) continue;
    if (torque_is_zero) force_N = 0.0;
    const bool pushes = force_N > kForceThreshold_N;
    if (pushes) fault.last_force_ns = now_ns;
    if (torque_is_zero && fault.torque_zero_ns == 0) fault.torque_zero_ns = now_ns;
    if (!pushes && fault.force_zero_ns == 0) fault.force_zero_ns = now_ns;
    if (fault.torque_zero_ns != 0)
      fault.largest_after_zero_N = std::max(fault.largest_after_zero_N, force_N);
    if (fault.force_zero_ns != 0)
      fault.largest_after_force_zero_N = std::max(fault.largest_after_force_zero_N, force_N);
  }
}

void FaultPlan::watchdog_tripped() {
  for (Fault& fault : faults_)
    if (fault.injected_ns != 0) ++fault.watchdog_trips;
}

}  // namespace tact::rig
