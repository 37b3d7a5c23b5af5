// SPDX-License-Identifier: Apache-2.0
// shutdown_frames.h - frames that zero the force after the process that drives a device died.
//
// A device provides them when it is opened: the messages of its own stop(), zero force first and
// then power off, as complete bytes, and the open descriptor to send them on. So a process that
// knows no device (firmware/guardian) can send them and computes nothing. The drives' own watchdog
// on their host stays active. A message is 16 bytes, as a CAN frame of the kernel and a
// packet of a Falcon are, or the 72 of a CAN FD frame.
//
//     kDatagrams   one message each, all of a step by one sendmmsg
//     kUsbBulk     one transfer each on `endpoint` (USBDEVFS_BULK); after a stall again
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tact::hal {

struct ShutdownFrames {
  static constexpr std::size_t kMax = 32;  // CiA 402 drives need 12
  enum class Carrier : std::uint8_t { kDatagrams, kUsbBulk };
  using Bytes = std::array<std::uint8_t, 16>;
  using LongBytes = std::array<std::uint8_t, 72>;

  Carrier carrier = Carrier::kDatagrams;
  std::uint8_t endpoint = 0;  // of kUsbBulk
  int fd = -1;                // the device's own, open as long as the device
  std::uint32_t count = 0, steps = 0;
  std::array<LongBytes, kMax> frame{};
  std::array<std::uint8_t, kMax> size{};  // of each frame
  std::array<std::uint8_t, kMax> step{};  // ascending; a millisecond lies between two steps

  /// Set-up: frames of the next step. False: there is no room for them.
  bool add_step(std::span<const Bytes> frames);
  bool add_step(std::span<const LongBytes> frames);
  /// As it leaves.
  std::span<const std::uint8_t> bytes_of(std::size_t i) const {
    return std::span(frame[i]).first(size[i] > sizeof(LongBytes) ? 0 : size[i]);
  }
};

/// The frames of one step, over `frames.fd`. 0: all are with the kernel; else an errno. Neither
/// heap nor lock.
int send_step(const ShutdownFrames& frames, std::uint32_t step);
/// All of them: zero force at once, the last after `steps` ms and what a full queue takes, 2 ms a
/// step (22 ms where a USB device does not answer). 0, or the errno of the first step that a device
/// did not take.
int send_all(const ShutdownFrames& frames);

}  // namespace tact::hal
