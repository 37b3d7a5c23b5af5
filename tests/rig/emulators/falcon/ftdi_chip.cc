// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/falcon/ftdi_chip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact::rig {
namespace {

constexpr std::int64_t kBootLoaderBusy_ns = 5'000'000;  // CTS stays low after DTR falls
constexpr std::uint8_t kModemIdle = 0x01, kCts = 0x10;
constexpr double kBitsPerByte = 10.0;

}  // namespace

void FtdiChip::reset() {
  to_device_.clear();
  from_device_.clear();
  divisor_ = 0x4138;
  latency_ns_ = 16'000'000;
  dtr_ = event_on_ = said_clear_ = false;
}

std::int64_t FtdiChip::byte_ns() const {
  return std::llround(1e9 * kBitsPerByte / ftdi_baud(divisor_));
}

bool FtdiChip::is_clear_to_send(std::int64_t now_ns) const {
  return firmware_.is_ready_for_upload() && now_ns >= busy_until_ns_;
}

std::optional<std::vector<std::uint8_t>> FtdiChip::control(const FtdiSetup& setup,
                                                           std::int64_t now_ns) {
  const std::vector<std::uint8_t> done;
  if (setup.type == 0xC0 && setup.request == 5) {
    const std::uint8_t cts = is_clear_to_send(now_ns) ? kCts : 0;
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(kModemIdle | cts), 0x60};
  }
  if (setup.type == 0xC0 && setup.request == 10)
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(latency_ns_ / 1'000'000)};
  if (setup.type != 0x40 || setup.length != 0) return std::nullopt;
  switch (setup.request) {
    case 0:
      if (setup.value == 0) reset();
      if (setup.value <= 1) from_device_.clear();
      return setup.value <= 2 ? std::optional(done) : std::nullopt;
    case 1: {
      if ((setup.value & 0x0100) == 0) return done;
      const bool high = (setup.value & 0x0001) != 0;
      if (high && !dtr_) firmware_.reset();
      if (!high && dtr_) busy_until_ns_ = now_ns + kBootLoaderBusy_ns;
      dtr_ = high;
      return done;
    }
    case 2:
    case 4:
      return done;
    case 3:
      // About every second change of speed leaves a null byte.
      if (leaves_nulls_ && setup.value != divisor_ && ++divisor_changes_ % 2 == 1)
        from_device_.push_back({now_ns, 0});
      divisor_ = setup.value;
      return done;
    case 6:
      event_ = static_cast<std::uint8_t>(setup.value & 0xFF);
      event_on_ = (setup.value & 0x100) != 0;
      return done;
    case 9:
      if (setup.value < 1 || setup.value > 255) return std::nullopt;
      latency_ns_ = setup.value * std::int64_t{1'000'000};
      return done;
    default:
      return std::nullopt;
  }
}

void FtdiChip::write(std::span<const std::uint8_t> data, std::int64_t now_ns) {
  for (const std::uint8_t byte : data) {
    device_free_ns_ = std::max(device_free_ns_, now_ns) + byte_ns();
    to_device_.push_back({device_free_ns_, byte});
  }
}

void FtdiChip::advance(std::int64_t now_ns) {
  while (!to_device_.empty() && to_device_.front().time_ns <= now_ns) {
    const Byte byte = to_device_.front();
    to_device_.pop_front();
    firmware_.receive(byte.value, ftdi_baud(divisor_), byte.time_ns, [&](std::uint8_t out) {
      host_free_ns_ = std::max(host_free_ns_, byte.time_ns) + byte_ns();
      from_device_.push_back({host_free_ns_, out});
    });
  }
}

std::int64_t FtdiChip::ready_ns() const {
  std::int64_t ready = last_packet_ns_ + latency_ns_;
  if (from_device_.size() >= kFtdiData)
    ready = std::min(ready, from_device_[kFtdiData - 1].time_ns);
  if (!event_on_) return ready;
  for (const Byte& byte : from_device_) {
    if (byte.value != event_) continue;
    return std::min(ready, byte.time_ns);
  }
  return ready;
}

std::optional<std::vector<std::uint8_t>> FtdiChip::packet(std::int64_t now_ns) {
  const bool clear = is_clear_to_send(now_ns);
  if (ready_ns() > now_ns && clear == said_clear_) return std::nullopt;
  said_clear_ = clear;
  last_packet_ns_ = now_ns;
  std::vector<std::uint8_t> data;
  while (!from_device_.empty() && data.size() < kFtdiData &&
         from_device_.front().time_ns <= now_ns) {
    data.push_back(from_device_.front().value);
    from_device_.pop_front();
  }
  const std::uint8_t cts = clear ? kCts : 0;
  return ftdi_packet({static_cast<std::uint8_t>(kModemIdle | cts), 0x60}, data);
}

std::int64_t FtdiChip::arrival_ns() const {
  return to_device_.empty() ? std::numeric_limits<std::int64_t>::max() : to_device_.back().time_ns;
}

}  // namespace tact::rig
