// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/falcon/falcon_usb.h"

#include <algorithm>
#include <cerrno>
#include <string_view>

namespace tact::rig {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kPacket = 64;
constexpr int kTransfersPerTurn = 32;

constexpr std::uint8_t kDeviceDescriptor[]{18,   1,    0x00, 0x02, 0,    0, 0, 8, 0x03,
                                           0x04, 0x48, 0xCB, 0x00, 0x06, 1, 2, 0, 1};
constexpr std::uint8_t kConfiguration[]{
    9, 2, 32,   0, 1,       1,    0,    0x80, 45,  // bus powered, 90 mA
    9, 4, 0,    0, 2,       0xFF, 0xFF, 0xFF, 0,   // vendor specific
    7, 5, 0x81, 2, kPacket, 0,    0,               // bulk IN
    7, 5, 0x02, 2, kPacket, 0,    0};              // bulk OUT

Bytes string_descriptor(std::uint8_t number) {
  constexpr std::string_view kStrings[] = {"", "EMULATED", "FALCON HAPTIC"};
  if (number == 0) return {4, 3, 0x09, 0x04};
  if (number >= std::size(kStrings)) return {};
  Bytes bytes{static_cast<std::uint8_t>(2 + 2 * kStrings[number].size()), 3};
  for (const char letter : kStrings[number]) {
    bytes.push_back(static_cast<std::uint8_t>(letter));
    bytes.push_back(0);
  }
  return bytes;
}

}  // namespace

std::int64_t FalconUsb::due_ns(std::int64_t asked_ns) const {
  return frame_ns_ == 0 ? asked_ns : (asked_ns / frame_ns_ + 1) * frame_ns_;
}

void FalconUsb::unplugged() {
  port_.detach();
  out_.clear();
  in_.clear();
  partly_.clear();
  chip_.reset();
}

void FalconUsb::take(const UsbipRequest& request) {
  if (!request.is_unlink) {
    const bool bulk_in = request.urb.is_in && request.urb.endpoint != 0;
    (bulk_in ? in_ : out_).push_back(request.urb);
    return;
  }
  const auto is_victim = [&](const Urb& urb) { return urb.number == request.victim; };
  if (!in_.empty() && is_victim(in_.front())) partly_.clear();
  const auto removed = std::erase_if(in_, is_victim) + std::erase_if(out_, is_victim);
  port_.answer_unlink(request.number, removed != 0);
}

void FalconUsb::serve(std::int64_t now_ns) {
  for (int i = 0; i < kTransfersPerTurn; ++i) {
    const auto request = port_.receive(now_ns);
    if (!request) break;
    take(*request);
  }
  chip_.advance(now_ns);
  outputs(now_ns);
  chip_.advance(now_ns);
  // What came after the last boundary waits for the next.
  inputs(frame_ns_ == 0 ? now_ns : now_ns - now_ns % frame_ns_);
}

std::optional<Bytes> FalconUsb::standard(const FtdiSetup& setup) const {
  enum : std::uint8_t {
    kGetStatus,
    kClearFeature,
    kGetDescriptor = 6,
    kGetConfiguration = 8,
    kSetConfiguration,
    kSetInterface = 11
  };
  switch (setup.request) {
    case kGetStatus:
      return Bytes{0, 0};
    case kGetConfiguration:
      return Bytes{1};
    case kGetDescriptor: {
      const auto number = static_cast<std::uint8_t>(setup.value & 0xFF);
      Bytes bytes =
          setup.value >> 8 == 1 ? Bytes(std::begin(kDeviceDescriptor), std::end(kDeviceDescriptor))
          : setup.value >> 8 == 2 ? Bytes(std::begin(kConfiguration), std::end(kConfiguration))
          : setup.value >> 8 == 3 ? string_descriptor(number)
                                  : Bytes{};
      return bytes.empty() ? std::nullopt : std::optional(bytes);
    }
    case kClearFeature:
    case kSetConfiguration:
    case kSetInterface:
      return Bytes{};
    default:
      return std::nullopt;
  }
}

void FalconUsb::control(const Urb& urb, std::int64_t now_ns) {
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint16_t>(urb.setup[at] | urb.setup[at + 1] << 8);
  };
  const FtdiSetup setup{urb.setup[0], urb.setup[1], word(2), word(4), word(6)};
  const bool is_standard = (setup.type & 0x60u) == 0;
  auto answer = is_standard ? standard(setup) : chip_.control(setup, now_ns);
  if (!answer) {
    port_.complete(urb, -EPIPE, {});
    return;
  }
  answer->resize(std::min<std::size_t>(answer->size(), setup.length));
  port_.complete(urb, 0, *answer);
}

void FalconUsb::outputs(std::int64_t now_ns) {
  while (!out_.empty() && due_ns(out_.front().submitted_ns) <= now_ns) {
    const Urb urb = std::move(out_.front());
    out_.pop_front();
    if (urb.endpoint == 0) {
      control(urb, now_ns);
    } else if (faults_.active(FaultKind::kStall, -1, now_ns)) {
      port_.complete(urb, -EPIPE, {});
    } else {
      chip_.write(urb.data, due_ns(urb.submitted_ns));
      port_.complete(urb, 0, {});
    }
  }
}

void FalconUsb::inputs(std::int64_t now_ns) {
  while (!in_.empty() && due_ns(in_.front().submitted_ns) <= now_ns) {
    if (faults_.active(FaultKind::kStall, -1, now_ns) ||
        faults_.once(FaultKind::kStall, -1, now_ns)) {
      port_.complete(in_.front(), -EPIPE, {});
      in_.pop_front();
      continue;
    }
    auto packet = chip_.packet(now_ns);
    if (!packet) return;
    const bool has_data = packet->size() > 2;
    if (has_data && (faults_.active(FaultKind::kShort, -1, now_ns) ||
                     faults_.once(FaultKind::kShort, -1, now_ns)))
      packet->resize(1);
    partly_.insert(partly_.end(), packet->begin(), packet->end());
    // A full packet leaves room for the next of the same transfer; a shorter one ends it.
    if (packet->size() == kPacket && partly_.size() + kPacket <= in_.front().length) continue;
    const int status = partly_.size() > in_.front().length ? -EOVERFLOW : 0;
    if (has_data) sent_(now_ns);
    port_.complete(in_.front(), status, partly_);
    partly_.clear();
    in_.pop_front();
  }
}

std::int64_t FalconUsb::next_ns() const {
  std::int64_t next = chip_.arrival_ns();
  if (!out_.empty()) next = std::min(next, due_ns(out_.front().submitted_ns));
  if (in_.empty()) return next;
  // A packet is fetched on a boundary, and not before it was asked.
  std::int64_t fetched_ns = std::max(chip_.ready_ns(), due_ns(in_.front().submitted_ns));
  if (frame_ns_ > 0) fetched_ns = (fetched_ns + frame_ns_ - 1) / frame_ns_ * frame_ns_;
  return std::min(next, fetched_ns);
}

}  // namespace tact::rig
