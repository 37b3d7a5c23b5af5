// SPDX-License-Identifier: Apache-2.0
// falcon_usb.h - the USB side of the emulated Falcon: descriptors, transfers in frames, faults.
//
// 0403:CB48 "FALCON HAPTIC", full speed, one interface, bulk 0x02 OUT and 0x81 IN of 64 bytes. A
// transfer completes on the first boundary of `frame_us` after it was asked, as a host controller
// serves it: 1000 is a full-speed frame, 125 a microframe, 0 at once. Source: USB 2.0, chapter 9.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "tests/rig/emulators/falcon/ftdi_chip.h"
#include "tests/rig/emulators/falcon/usbip_port.h"

namespace tact::rig {

class FalconUsb {
 public:
  /// All outlive it. `sent`: a packet with data goes to the host now.
  FalconUsb(UsbipPort& port, FtdiChip& chip, FaultPlan& faults, int frame_us,
            std::function<void(std::int64_t now_ns)> sent)
      : port_(port),
        chip_(chip),
        faults_(faults),
        frame_ns_(frame_us * std::int64_t{1000}),
        sent_(std::move(sent)) {}

  /// Take what the host asks, complete what is due.
  void serve(std::int64_t now_ns);
  /// When there is something to do without a new request.
  std::int64_t next_ns() const;
  void unplugged();

 private:
  std::int64_t due_ns(std::int64_t asked_ns) const;
  void take(const UsbipRequest& request);
  void control(const Urb& urb, std::int64_t now_ns);
  void outputs(std::int64_t now_ns);
  void inputs(std::int64_t now_ns);
  std::optional<std::vector<std::uint8_t>> standard(const FtdiSetup& setup) const;

  UsbipPort& port_;
  FtdiChip& chip_;
  FaultPlan& faults_;
  std::int64_t frame_ns_;
  std::function<void(std::int64_t)> sent_;
  std::deque<Urb> out_, in_;          // control among the OUTs, in order
  std::vector<std::uint8_t> partly_;  // of the first IN, when it is longer than a packet
};

}  // namespace tact::rig
