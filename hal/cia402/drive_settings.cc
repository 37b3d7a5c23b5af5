// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/drive_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tact::hal::cia402 {
namespace {

// Chosen: 0.2 s for a mode to show in 6061.
constexpr int kModeLooks = 20, kModeLook_ms = 10;
constexpr std::uint32_t kModeCst = 10;  // in 6060 and 6061
constexpr std::uint32_t kNoObject = 0x06020000, kNoSubIndex = 0x06090011;

}  // namespace

std::optional<std::string> DriveSettings::write(int node, CstConfiguration wanted) {
  SdoFailure failure;
  const auto sample_id = sdo_.read(node, {0x1800, 1, 4}, failure);
  if (!sample_id) return sdo_failure_text(failure, 0x1800, 1);
  wanted.sample_without_request = (*sample_id & kCstWithoutRequest) != 0;
  const auto writes = cst_configuration(node, wanted);
  if (!writes) return "cannot have this node: device.can.node takes 1 to 126";
  // First: a drive that is refused for it keeps what another host has set.
  if (auto words = check_heartbeat(node)) return words;
  if (auto words = end_guarding(node)) return words;
  // Before 1016 is written: a watch that runs may refuse it (0x06040043, CN-4).
  if (auto words = end_watch(node, wanted)) return words;
  if (auto words = end_other_watches(node, wanted)) return words;
  if (auto words = expect_sync(node, wanted)) return words;
  for (const SdoWrite& one : *writes) {
    const auto refused = sdo_.write(node, one);
    if (refused && (refused->silent || !may_lack(node, one.index)))
      return sdo_failure_text(*refused, one.index, one.sub);
  }
  // 0: a quick stop lets go; a ramp would drive the arm against the hand.
  const auto refused = sdo_.write(node, {.index = 0x605A, .sub = 0, .value = 0, .size = 2});
  if (refused && (refused->silent || !may_lack(node, 0x605A)))
    return sdo_failure_text(*refused, 0x605A, 0);
  return check_mode(node);
}

std::optional<std::string> DriveSettings::check_heartbeat(int node) {
  for (const SdoEntry& entry : {SdoEntry{0x1017, 0, 2}, SdoEntry{0x1016, 1, 4}}) {
    SdoFailure failure;
    if (sdo_.read(node, entry, failure)) continue;
    if (failure.silent) return sdo_failure_text(failure, entry.index, entry.sub);
    // Any other answer means that it has the object: writing it will show.
    if (failure.abort_code != kNoObject && failure.abort_code != kNoSubIndex) continue;
    return fmt::format(
        "{} (object {:04X}), and its node guarding (object 100C) is not used: update its firmware, "
        "or take a drive with heartbeat",
        entry.index == 0x1017 ? "sends no heartbeat" : "does not watch the controller's heartbeat",
        entry.index);
  }
  return std::nullopt;
}

/// Off as soon as one of the two is zero or not there; both are cleared: some want that (CN-6).
std::optional<std::string> DriveSettings::end_guarding(int node) {
  bool off = false;
  std::string refusal;
  for (const SdoEntry& entry : {SdoEntry{0x100C, 0, 2}, SdoEntry{0x100D, 0, 1}}) {
    SdoFailure failure;
    const auto value = sdo_.read(node, entry, failure);
    if (failure.silent) return sdo_failure_text(failure, entry.index, entry.sub);
    // Another abort than these says nothing of the object: the write decides.
    const bool absent = failure.abort_code == kNoObject || failure.abort_code == kNoSubIndex;
    const bool unset = value ? *value == 0 : absent;
    const auto refused =
        unset ? std::nullopt
              : sdo_.write(node, {.index = entry.index, .sub = 0, .value = 0, .size = entry.size});
    off = off || !refused;
    if (refused) refusal = sdo_failure_text(*refused, entry.index, entry.sub);
  }
  if (off) return std::nullopt;
  return fmt::format(
      "keeps its node guarding on (objects 100C, 100D), which does not go with heartbeat: set both "
      "to 0 with its vendor's program. It {}",
      refusal);
}

std::optional<std::string> DriveSettings::end_watch(int node, const CstConfiguration& wanted) {
  SdoFailure failure;
  const auto watch = sdo_.read(node, {0x1016, 1, 4}, failure);
  if (watch && (*watch & 0xFFFFu) == 0) return std::nullopt;
  // Its own node stays, the time goes: a zero as a whole would name no node, and be ignored (CN-4).
  const std::uint32_t off = watch ? *watch & 0x7F0000u : host_watch(wanted, 0);
  const auto refused = sdo_.write(node, {.index = 0x1016, .sub = 1, .value = off, .size = 4});
  if (refused) return sdo_failure_text(*refused, 0x1016, 1);
  return std::nullopt;
}

/// Two watches over one node are refused (0x06040043); and the other one would outlive the loop.
std::optional<std::string> DriveSettings::end_other_watches(int node,
                                                            const CstConfiguration& wanted) {
  SdoFailure failure;
  const auto count = sdo_.read(node, {0x1016, 0, 1}, failure).value_or(1);
  for (std::uint8_t sub = 2; sub <= std::min(count, 127u); ++sub) {
    const auto watch = sdo_.read(node, {0x1016, sub, 4}, failure);
    if (failure.silent) return sdo_failure_text(failure, 0x1016, sub);
    if (!watch || (*watch & 0xFFFFu) == 0) continue;
    if ((*watch & 0x7F0000u) != host_watch(wanted, 0)) continue;
    const auto refused =
        sdo_.write(node, {.index = 0x1016, .sub = sub, .value = host_watch(wanted, 0), .size = 4});
    if (refused) return sdo_failure_text(*refused, 0x1016, sub);
  }
  return std::nullopt;
}

/// Its identifier always: after a reset some drives know it again only when it is written (CN-7).
/// Of period and counter, 0 means that a drive does not ask.
std::optional<std::string> DriveSettings::expect_sync(int node, const CstConfiguration& wanted) {
  SdoFailure failure;
  const auto write = [&](const SdoWrite& what) -> std::optional<std::string> {
    const auto refused = sdo_.write(node, what);
    if (refused) return sdo_failure_text(*refused, what.index, what.sub);
    return std::nullopt;
  };
  auto words = write({.index = 0x1005, .sub = 0, .value = kCanopenSyncId, .size = 4});
  // One that cannot be written may be right already, or not there.
  const std::uint32_t has = sdo_.read(node, {0x1005, 0, 4}, failure).value_or(kCanopenSyncId);
  if (words && (has & 0x7FFF'FFFFu) != kCanopenSyncId) return words;
  const std::uint32_t period_us = 1000u * wanted.period_ms;
  const std::uint32_t counter = sdo_.read(node, {0x1019, 0, 1}, failure).value_or(0);
  const std::uint32_t reported_us = sdo_.read(node, {0x1006, 0, 4}, failure).value_or(0);
  if (counter != 0) {
    // CiA 301: while there is a period, the counter does not change.
    if (reported_us != 0)
      if (auto error = write({.index = 0x1006, .sub = 0, .value = 0, .size = 4})) return error;
    if (auto error = write({.index = 0x1019, .sub = 0, .value = 0, .size = 1})) return error;
  }
  if (reported_us == 0 || (counter == 0 && reported_us == period_us)) return std::nullopt;
  return write({.index = 0x1006, .sub = 0, .value = period_us, .size = 4});
}

/// Some drives show their mode late, or not at all, but never another one.
std::optional<std::string> DriveSettings::check_mode(int node) {
  SdoFailure failure;
  std::uint32_t mode = 0;
  for (int looks = 0; looks < kModeLooks; ++looks) {
    const auto shown = sdo_.read(node, {0x6061, 0, 1}, failure);
    if (!shown || *shown == kModeCst) return std::nullopt;
    mode = *shown;
    sdo_.wait(kModeLook_ms);
  }
  // 0 is "no mode yet": only another mode is a refusal.
  if (mode == 0) return std::nullopt;
  return fmt::format(
      "stays in mode {} of operation (object 6061) and does not take cyclic synchronous torque, "
      "{}: set it with its vendor's program",
      static_cast<std::int8_t>(mode), kModeCst);
}

bool DriveSettings::may_lack(int node, std::uint16_t index) {
  for (Optional& one : optional_) {
    if (one.index != index) continue;
    // Once a drive, although 60C2 is written in two parts, and all of it twice after a reset.
    if (std::ranges::find(one.nodes, node) == one.nodes.end()) one.nodes.push_back(node);
    return true;
  }
  return false;
}

std::string DriveSettings::caution() const {
  std::string all;
  for (const Optional& one : optional_) {
    if (one.nodes.empty()) continue;
    all += fmt::format("{}the drives of nodes {} have no setting 0x{:04X}: {}",
                       all.empty() ? "" : "; ", fmt::join(one.nodes, ", "), one.index, one.words);
  }
  return all;
}

}  // namespace tact::hal::cia402
