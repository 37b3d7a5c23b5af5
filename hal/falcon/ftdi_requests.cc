// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/ftdi_requests.h"

#include <algorithm>
#include <array>

namespace tact::hal::falcon {

std::optional<double> ftdi_baud_Hz(std::uint16_t code) RT_SAFE {
  constexpr double kClock_Hz = 3e6;
  constexpr std::array<double, 4> kFraction{0.0, 0.5, 0.25, 0.125};
  // AN232B-05: 0 and 1 are codes of their own, not divisors.
  if (code == 0) return kClock_Hz;
  if (code == 1) return kClock_Hz / 1.5;
  const unsigned whole = code & 0x3FFFu;
  if (whole < 2) return std::nullopt;
  return kClock_Hz / (whole + kFraction[code >> 14]);
}

std::optional<FtdiRead> ftdi_strip(std::span<const std::uint8_t> transfer,
                                   std::span<std::uint8_t> data) RT_SAFE {
  const std::size_t packets = (transfer.size() + kFtdiPacketSize - 1) / kFtdiPacketSize;
  const std::size_t last = transfer.size() % kFtdiPacketSize;  // 0: the last one is full
  if (packets == 0 || last == 1) return std::nullopt;
  if (data.size() < transfer.size() - packets * kFtdiStatusSize) return std::nullopt;
  FtdiRead out;
  unsigned errors = 0;
  // bound: packets of a transfer
  for (std::size_t at = 0; at < transfer.size(); at += kFtdiPacketSize) {
    const auto packet = transfer.subspan(at, std::min(kFtdiPacketSize, transfer.size() - at));
    out.modem = packet[0];
    out.line = packet[1];
    errors |= packet[1] & unsigned{kFtdiLineErrors};
    // Forward, and never past what is read: `data` may begin where the transfer does.
    // bound: bytes of a packet
    for (const std::uint8_t byte : packet.subspan(kFtdiStatusSize)) data[out.size++] = byte;
  }
  // An error of an earlier packet is reported, although the last one no longer shows it.
  out.line = static_cast<std::uint8_t>(out.line | errors);
  return out;
}

const char* ftdi_line_error(std::uint8_t bit) RT_SAFE {
  switch (bit) {
    case kFtdiOverrun:
      return "bytes were lost in the USB adapter: the PC fetched them too late; plug the device "
             "into a port of its own, without a hub, and end other programs";
    case kFtdiParity:
      return "a byte arrived with wrong parity: the serial line is disturbed or set up wrongly; "
             "unplug the device and plug it in again";
    case kFtdiFraming:
      return "a byte arrived without its stop bit: both ends speak at different speeds; unplug the "
             "device's USB and power, plug both in again";
    case kFtdiBreak:
      return "the device holds its serial line down: it has no power or restarts; is its power "
             "supply plugged in?";
    default:
      return "";
  }
}

}  // namespace tact::hal::falcon
