// SPDX-License-Identifier: Apache-2.0
// heartbeat_guard.h - a drive's watch over the host's heartbeat (object 1016): on before it gets
// power, off when it lets go, so that the end of the loop is no fault in its log (CN-4).
//
//     1016:01 = host node << 16 | timeout, ms       0 instead of the timeout: no monitoring
//
// A watch that is on cannot be written again in some drives (abort 0x06040043): where "on" was
// refused or left open, "off" comes first.
//
// One expedited SDO download in the loop's own batch, one answer; the next only when that came or
// 200 ticks are over. A drive that refuses "off" while operational is left on; it then notes
// a heartbeat fault (EMCY 0x8130) at the end of a run, as after a killed one, and the next start
// resets that. A drive that refuses or leaves open "on" gets no power. CiA 301, 7.5.2.19.
#pragma once

#include <optional>

#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/cia402_cst.h"

namespace tact::hal::cia402 {

class HeartbeatGuard {
 public:
  static constexpr int kTimeout_ticks = 200;

  /// The drive watches and has said so: tactd is the only one that may drive it.
  bool on() const RT_SAFE { return known_ && on_; }

  /// What to send in this tick, if anything, so that the watch becomes `wanted`.
  std::optional<can::CanFrame> step(bool wanted, int node, const CstConfiguration& can) RT_SAFE {
    if (waiting_ticks_ > 0) --waiting_ticks_;
    if (waiting_ticks_ > 0) return std::nullopt;
    const bool settled = known_ && on_ == wanted;
    if (settled || (!wanted && refuses_off_)) return std::nullopt;
    const bool open = !known_ && asked_;  // the last "on"
    known_ = false;
    asked_ = wanted && (!open || refuses_off_);
    clears_ = wanted && !asked_;
    waiting_ticks_ = kTimeout_ticks;
    const std::uint32_t value = host_watch(can, asked_ ? can.host_timeout_ms : std::uint16_t{0});
    return canopen_sdo_download(node, {.index = 0x1016, .sub = 1, .value = value, .size = 4});
  }

  /// The drive's answer; others than to the last question are not ours.
  void take(const SdoReply& reply) RT_SAFE {
    if (waiting_ticks_ <= 0 || reply.index != 0x1016 || reply.sub != 1) return;
    const bool done = reply.kind == SdoReplyKind::kDownloadDone;
    if (done || !asked_) waiting_ticks_ = 0;  // a refused "on" is asked for again, but not at once
    known_ = done || (!asked_ && !clears_);
    on_ = done ? asked_ : true;
    refuses_off_ = refuses_off_ || (!done && !asked_);
  }

 private:
  bool known_ = true, on_ = true;  // the bring-up wrote it
  bool asked_ = true;
  bool clears_ = false;  // asks for "off" so that "on" can be asked for
  bool refuses_off_ = false;
  int waiting_ticks_ = 0;
};

}  // namespace tact::hal::cia402
