// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/falcon/falcon_firmware.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/rig/emulators/mechanics/falcon_mechanism.h"

namespace tact::rig {
namespace {

constexpr double kBootBaud = 9600.0, kUploadBaud = 142'857.0, kRunBaud = 1.5e6;
constexpr double kBaudTolerance = 0.03;
constexpr std::array<std::uint8_t, 3> kGreetingBytes{0x0A, 0x43, 0x0D};
constexpr std::uint8_t kGreetingReply[] = {0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t kLock = 0x41;
// What the counters show before they know their zero.
constexpr std::array<int, 3> kUnhomedOffset{-311, 207, 96};
constexpr double kFirstHomed = 0.6, kHomedStep = 0.2;  // shares of the homing motion

bool fits(double baud, double wanted) { return std::abs(baud - wanted) < kBaudTolerance * wanted; }

}  // namespace

void FalconFirmware::reset() {
  mode_ = kGreeting;
  uploaded_ = homed_ = 0;
  homing_ns_ = command_ns_ = 0;
  motor_ = {};
  last_ = {};
  scanner_.clear();
}

Joints FalconFirmware::torque_Nm() const {
  Joints torque{};
  for (std::size_t i = 0; i < 3; ++i) torque[i] = -settings_.torque_per_word_Nm * motor_[i];
  return torque;
}

bool FalconFirmware::took_command() { return std::exchange(took_, false); }
bool FalconFirmware::tripped() { return std::exchange(tripped_, false); }

double FalconFirmware::homing_share(std::int64_t now_ns) const {
  if (homing_ns_ == 0) return 0.0;
  return std::min(1.0, 1e-6 * static_cast<double>(now_ns - homing_ns_) /
                           std::max(1.0, static_cast<double>(settings_.homing_ms)));
}

void FalconFirmware::receive(std::uint8_t byte, double baud, std::int64_t now_ns,
                             const Answer& answer) {
  if (faults_.active(FaultKind::kUnpowered, -1, now_ns)) return;
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_.back() = byte;
  switch (mode_) {
    case kDead:
      return;
    case kGreeting:
      if (!fits(baud, kBootBaud) || last_ != kGreetingBytes) return;
      for (const std::uint8_t out : kGreetingReply) answer(out);
      mode_ = kAutobaud;
      return;
    case kAutobaud:
      if (fits(baud, kBootBaud) && last_ == kGreetingBytes) {  // asked once more
        for (const std::uint8_t out : kGreetingReply) answer(out);
      } else if (fits(baud, kUploadBaud) && byte == kLock) {
        answer(byte);
        mode_ = kUpload;
      }
      return;
    case kUpload:
      if (!fits(baud, kUploadBaud)) return;
      answer(byte);
      if (++uploaded_ == settings_.image_bytes) mode_ = kRun;
      return;
    case kRun:
      if (!fits(baud, kRunBaud)) return;
      if (const auto frame = scanner_.push(byte)) obey(decode_command(*frame), now_ns, answer);
      return;
  }
}

void FalconFirmware::obey(const FalconCommand& command, std::int64_t now_ns, const Answer& answer) {
  motor_ = command.motor;
  command_ns_ = now_ns;
  took_ = true;
  if (command.homing && homing_ns_ == 0) homing_ns_ = now_ns;
  FalconReport report;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (command.homing && homing_share(now_ns) >= kFirstHomed + kHomedStep * i) homed_ |= 1 << i;
    const bool knows = (homed_ >> i & 1) != 0;
    report.counts[axis] =
        static_cast<int>(falcon_counts(theta_rad_[axis])) + (knows ? 0 : kUnhomedOffset[axis]);
  }
  report.homed = homed_;
  if (faults_.active(FaultKind::kNoReply, -1, now_ns)) return;
  FalconFrame frame = encode_report(report);
  if (faults_.active(FaultKind::kGarbage, -1, now_ns)) {
    for (std::uint8_t& byte : frame) {
      noise_ = noise_ * 1664525u + 1013904223u;
      byte = static_cast<std::uint8_t>(noise_ >> 24u);
    }
  }
  const int times = faults_.active(FaultKind::kDuplicate, -1, now_ns) ? 2 : 1;
  for (int i = 0; i < times; ++i)
    for (const std::uint8_t byte : frame) answer(byte);
}

void FalconFirmware::tick(std::int64_t now_ns) {
  if (faults_.active(FaultKind::kUnpowered, -1, now_ns)) {
    const bool keeps = settings_.runs_already;
    reset();
    mode_ = keeps ? kRun : kDead;
  }
  if (settings_.watchdog_ms == 0 || motor_ == std::array<int, 3>{} ||
      now_ns - command_ns_ <= settings_.watchdog_ms * std::int64_t{1'000'000})
    return;
  motor_ = {};
  tripped_ = true;
}

}  // namespace tact::rig
