// SPDX-License-Identifier: Apache-2.0
// ftdi_requests.h - how an FT232 USB-to-serial chip is set up, and what it adds to what it reads.
//
// Set-up: vendor control requests, type 0x40, without data. Reading: each USB packet, not each
// transfer, starts with two status bytes, so in a transfer longer than a packet they repeat:
//
//     modem  CTS 0x10, DSR 0x20, RI 0x40, DCD 0x80
//     line   overrun 0x02, parity 0x04, framing 0x08, break 0x10; 0x20 and 0x40: nothing to send
//
//     baud = 3 MHz / divisor;  divisor code: bits 13..0 whole part, bits 15..14 fraction
//     (0: .0, 1: .5, 2: .25, 3: .125);  codes 0 and 1 stand for 3 and 2 MBd
//
// Source: FP-1; FTDI note AN232B-05 (baud rates), and Linux drivers/usb/serial/ftdi_sio.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "model/rt.h"

namespace tact::hal::falcon {

struct FtdiRequest {
  std::uint8_t type = 0x40;  // bmRequestType: to the device, vendor
  std::uint8_t request = 0;  // bRequest
  std::uint16_t value = 0;   // wValue
  std::uint16_t index = 0;   // wIndex
  std::uint16_t length = 0;  // wLength
  bool operator==(const FtdiRequest&) const = default;
};

constexpr FtdiRequest ftdi_request(std::uint8_t request, std::uint16_t value) RT_SAFE {
  return {.request = request, .value = value};
}

inline constexpr FtdiRequest kFtdiPurgeRx = ftdi_request(0, 1), kFtdiPurgeTx = ftdi_request(0, 2);
inline constexpr FtdiRequest kFtdiDtrLow = ftdi_request(1, 0x0100),
                             kFtdiDtrHigh = ftdi_request(1, 0x0101),
                             kFtdiRtsLow = ftdi_request(1, 0x0200),
                             kFtdiRtsHigh = ftdi_request(1, 0x0202);
inline constexpr FtdiRequest kFtdiFlowNone = ftdi_request(2, 0), kFtdi8n1 = ftdi_request(4, 8);

constexpr FtdiRequest ftdi_divisor(std::uint16_t code) RT_SAFE { return ftdi_request(3, code); }
/// How long a packet that is not full may be held back; at least 1 ms.
constexpr FtdiRequest ftdi_latency_ms(std::uint8_t latency_ms) RT_SAFE {
  return ftdi_request(9, latency_ms == 0 ? 1 : latency_ms);
}
/// The chip hands over what it has as soon as this byte arrives, before its latency timer (FP-5).
constexpr FtdiRequest ftdi_event_character(std::uint8_t character) RT_SAFE {
  return ftdi_request(6, static_cast<std::uint16_t>(0x0100 | character));
}

inline constexpr std::uint16_t kFtdi9600 = 0x4138, kFtdi142857 = 0x0015, kFtdi1500000 = 0x0002;
/// Nothing for a divisor that the chip does not have: below 2 only the codes 0 and 1 exist.
std::optional<double> ftdi_baud_Hz(std::uint16_t code) RT_SAFE;

inline constexpr std::size_t kFtdiPacketSize = 64, kFtdiStatusSize = 2;
inline constexpr std::uint8_t kFtdiClearToSend = 0x10;  // of modem
inline constexpr std::uint8_t kFtdiOverrun = 0x02, kFtdiParity = 0x04, kFtdiFraming = 0x08,
                              kFtdiBreak = 0x10;  // of line
inline constexpr std::uint8_t kFtdiLineErrors =
    kFtdiOverrun | kFtdiParity | kFtdiFraming | kFtdiBreak;

struct FtdiRead {
  std::size_t size = 0;    // bytes of data; none means that nothing has arrived
  std::uint8_t modem = 0;  // of the last packet
  std::uint8_t line = 0;   // of the last packet, with the errors of all
  bool clear_to_send() const RT_SAFE { return (modem & kFtdiClearToSend) != 0; }
};

/// Moves a transfer without its status bytes to `data`, which may begin where the transfer does.
/// Nothing when a packet is too short for its status (also a transfer of no bytes, which a chip
/// that is still there never sends), or when `data` is too small; then `data` is as it was.
std::optional<FtdiRead> ftdi_strip(std::span<const std::uint8_t> transfer,
                                   std::span<std::uint8_t> data) RT_SAFE;

/// What one error bit of the line status means, and the remedy; "" for any other bit.
const char* ftdi_line_error(std::uint8_t bit) RT_SAFE;

}  // namespace tact::hal::falcon
