// SPDX-License-Identifier: Apache-2.0
// ftdi_chip.h - the emulated USB adapter between bulk packets and the serial line (FT232 class).
//
// Bytes take 10 bits of the line's baud each, both ways. An IN packet is ready when 62 bytes wait,
// when the event character has come, when CTS changes, or when the latency timer ends: then with
// what there is, or with the two status bytes alone. Vendor requests, all with bmRequestType 0x40
// and no data: 0 reset and purge, 1 modem lines, 2 flow, 3 divisor, 4 format, 6 event character, 9
// latency; 0xC0: 5 modem status, 10 latency. Sources: FTDI AN232B-04; Linux,
// drivers/usb/serial/ftdi_sio.h.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tests/rig/emulators/falcon/falcon_firmware.h"
#include "tests/rig/emulators/falcon/falcon_wire.h"

namespace tact::rig {

struct FtdiSetup {  // of a control transfer
  std::uint8_t type, request;
  std::uint16_t value, index, length;
};

class FtdiChip {
 public:
  FtdiChip(FalconFirmware& firmware, bool leaves_nulls)
      : firmware_(firmware), leaves_nulls_(leaves_nulls) {}

  /// As after power-on of the adapter; the processor behind it goes on.
  void reset();
  /// The data of the answer; nothing: it stalls.
  std::optional<std::vector<std::uint8_t>> control(const FtdiSetup& setup, std::int64_t now_ns);
  void write(std::span<const std::uint8_t> data, std::int64_t now_ns);
  /// Let bytes arrive up to now.
  void advance(std::int64_t now_ns);
  /// The packet that is ready, if one is.
  std::optional<std::vector<std::uint8_t>> packet(std::int64_t now_ns);
  /// When `packet` will have one, if nothing else comes.
  std::int64_t ready_ns() const;
  /// When the last byte that is on the line reaches the processor; INT64_MAX: none is.
  std::int64_t arrival_ns() const;

 private:
  struct Byte {
    std::int64_t time_ns;
    std::uint8_t value;
  };
  std::int64_t byte_ns() const;
  bool is_clear_to_send(std::int64_t now_ns) const;

  FalconFirmware& firmware_;
  bool leaves_nulls_;
  std::uint16_t divisor_ = 0x4138;
  std::int64_t latency_ns_ = 16'000'000;
  bool dtr_ = false, event_on_ = false, said_clear_ = false;
  std::uint8_t event_ = 0;
  int divisor_changes_ = 0;
  std::deque<Byte> to_device_, from_device_;
  std::int64_t device_free_ns_ = 0, host_free_ns_ = 0, last_packet_ns_ = 0, busy_until_ns_ = 0;
};

}  // namespace tact::rig
