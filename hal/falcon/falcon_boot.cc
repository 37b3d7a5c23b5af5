// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_boot.h"

#include <algorithm>

namespace tact::hal::falcon {

using What = FalconBootAction::What;

std::span<const FtdiRequest> FalconBoot::requests() const noexcept {
  switch (stage_) {
    case Stage::kOpen:
      return kFalconOpenRequests;
    case Stage::kReport:
      return kFalconRunRequests;
    case Stage::kGreet:
      return kFalconBootRequests;
    case Stage::kSpeed:
      return kFalconSpeedRequests;
    default:
      return {};
  }
}

FalconBootAction FalconBoot::next(const FalconBootInput& input) noexcept {
  if (stage_ == Stage::kReady) return {.what = What::kReady};
  if (stage_ == Stage::kGivenUp) return {.what = What::kGiveUp};
  FalconBootAction action;
  if (input.failed) {
    action = restart(FalconBootFault::kTransport);
  } else if (last_ == What::kRead) {
    action = heard(input);
  } else if (last_ == What::kWrite) {
    // The time to answer begins when the write is through, not when it was asked for.
    deadline_ms_ = input.now_ms + wait_ms_;
    action = read(input.now_ms);
  } else if (request_ < requests().size()) {
    action = {.what = What::kControl, .request = requests()[request_++]};
  } else {
    action = exchange(input.now_ms);
  }
  last_ = action.what;
  return action;
}

FalconBootAction FalconBoot::enter(Stage stage, std::int64_t now_ms) noexcept {
  stage_ = stage;
  request_ = 0;
  tries_ = 0;
  if (stage == Stage::kReady) return {.what = What::kReady};
  if (requests().empty()) return exchange(now_ms);
  return {.what = What::kControl, .request = requests()[request_++]};
}

/// The requests of this stage are through: its first word, or its next.
FalconBootAction FalconBoot::exchange(std::int64_t now_ms) noexcept {
  // Bytes of an earlier try count for no later one.
  matched_ = 0;
  spoiled_ = null_seen_ = false;
  ++tries_;
  switch (stage_) {
    case Stage::kReport:
      if (tries_ == 1) stream_.reset();  // what came before is purged
      return write(question_, settings_.report_wait_ms);
    case Stage::kGreet:
      return write(kFalconGreeting, settings_.greeting_wait_ms);
    case Stage::kSpeed:  // the boot ROM says by CTS when it listens
      deadline_ms_ = now_ms + settings_.clear_to_send_wait_ms;
      return read(now_ms);
    case Stage::kLock:
      return write(kFalconSpeedLock, settings_.speed_lock_wait_ms);
    case Stage::kUpload:
      return write(image_.subspan(echoed_, std::min(kFalconChunk, image_.size() - echoed_)),
                   settings_.echo_wait_ms);
    default:
      return enter(Stage::kReport, now_ms);
  }
}

FalconBootAction FalconBoot::write(std::span<const std::uint8_t> bytes, int wait_ms) noexcept {
  wait_ms_ = wait_ms;
  return {.what = What::kWrite, .bytes = bytes};
}

FalconBootAction FalconBoot::read(std::int64_t now_ms) noexcept {
  const std::int64_t left_ms = deadline_ms_ - now_ms;
  // At least 1 ms: libusb takes 0 for "without end".
  return {.what = What::kRead, .wait_ms = static_cast<int>(std::max<std::int64_t>(left_ms, 1))};
}

/// Exactly the reply so far and nothing after it; one null may precede it, a change of speed leaves
/// one behind.
bool FalconBoot::matches(std::span<const std::uint8_t> bytes,
                         std::span<const std::uint8_t> reply) noexcept {
  for (const std::uint8_t byte : bytes)
    if (byte == 0 && matched_ == 0 && !null_seen_)
      null_seen_ = true;
    else if (matched_ < reply.size() && byte == reply[matched_])
      ++matched_;
    else
      spoiled_ = true;
  return matched_ == reply.size() && !spoiled_;
}

FalconBootAction FalconBoot::heard(const FalconBootInput& input) noexcept {
  switch (stage_) {
    case Stage::kReport:
      for (const std::uint8_t byte : input.bytes) {
        const auto report = stream_.push(byte);
        // A boot ROM in the middle of an image echoes the question, which looks like a report.
        if (report && encode(*report) != question_) return enter(Stage::kReady, input.now_ms);
      }
      break;
    case Stage::kGreet:
      if (matches(input.bytes, kFalconGreetingReply)) return enter(Stage::kSpeed, input.now_ms);
      break;
    case Stage::kSpeed:
      if (input.clear_to_send) return enter(Stage::kLock, input.now_ms);
      break;
    case Stage::kLock:
      if (matches(input.bytes, kFalconSpeedLock)) return enter(Stage::kUpload, input.now_ms);
      break;
    default:
      return heard_echo(input);
  }
  return input.now_ms < deadline_ms_ ? read(input.now_ms) : timed_out(input.now_ms);
}

FalconBootAction FalconBoot::heard_echo(const FalconBootInput& input) noexcept {
  const std::size_t chunk = std::min(kFalconChunk, image_.size() - echoed_);
  for (const std::uint8_t byte : input.bytes) {
    // More than was sent is as wrong as something else: the image would go on shifted.
    if (chunk_echoed_ == chunk || byte != image_[echoed_ + chunk_echoed_])
      return restart(FalconBootFault::kEchoDiffers);
    ++chunk_echoed_;
  }
  if (chunk_echoed_ < chunk)
    return input.now_ms < deadline_ms_ ? read(input.now_ms) : timed_out(input.now_ms);
  echoed_ += chunk;
  chunk_echoed_ = 0;
  if (echoed_ < image_.size()) return exchange(input.now_ms);
  uploaded_ = true;
  return enter(Stage::kReport, input.now_ms);
}

FalconBootAction FalconBoot::timed_out(std::int64_t now_ms) noexcept {
  switch (stage_) {
    case Stage::kReport:
      if (tries_ < settings_.report_tries) return exchange(now_ms);
      // The image went through and does not run: the reset by DTR has to come first again.
      if (uploaded_) return restart(FalconBootFault::kNoReport);
      if (!image_.empty()) return enter(Stage::kGreet, now_ms);
      return give_up(FalconBootFault::kNoImage);  // trying again would change nothing
    case Stage::kGreet:  // what came late or damaged must not meet the next answer
      if (tries_ < settings_.greeting_tries)
        // No request of the stage is left after it, so next() greets again.
        return {.what = What::kControl, .request = kFtdiPurgeRx};
      return restart(FalconBootFault::kNoGreeting);
    case Stage::kSpeed:  // not every adapter brings CTS: go on and see
      return enter(Stage::kLock, now_ms);
    case Stage::kLock:
      return restart(FalconBootFault::kNoSpeedLock);
    default:
      return restart(FalconBootFault::kEchoMissing);
  }
}

FalconBootAction FalconBoot::give_up(FalconBootFault fault) noexcept {
  fault_ = fault;
  stage_ = Stage::kGivenUp;
  return {.what = What::kGiveUp};
}

FalconBootAction FalconBoot::restart(FalconBootFault fault) noexcept {
  if (attempt_ >= settings_.attempts) return give_up(fault);
  fault_ = fault;
  ++attempt_;
  stage_ = Stage::kOpen;
  request_ = 0;
  // The reset throws away what was sent: the image begins with its first byte again.
  uploaded_ = false;
  echoed_ = chunk_echoed_ = 0;
  return {.what = What::kReopen};
}

const char* falcon_boot_advice(FalconBootFault fault) noexcept {
  switch (fault) {
    case FalconBootFault::kNone:
      return "";
    case FalconBootFault::kTransport:
      return "the Falcon cannot be spoken to over USB: is it plugged in, used by no other program, "
             "and may this user open it (udev rule)?";
    case FalconBootFault::kNoImage:
      return "the Falcon runs no firmware and none is named: name the file of your copy in the "
             "scene";
    case FalconBootFault::kNoGreeting:
      return "the Falcon's boot ROM does not answer: is its power supply plugged in? Unplug power "
             "and USB for ten seconds";
    case FalconBootFault::kNoSpeedLock:
      return "the Falcon's boot ROM does not follow to the higher speed: unplug power and USB for "
             "ten seconds";
    case FalconBootFault::kEchoMissing:
      return "the Falcon stopped in the middle of the firmware: plug it into a port of its own, "
             "without a hub, and try again";
    case FalconBootFault::kEchoDiffers:
      return "the Falcon received damaged firmware: plug it into a port of its own, without a hub, "
             "and try again";
    case FalconBootFault::kNoReport:
      return "the Falcon took the firmware and does not answer: is it the right file for this "
             "device? Unplug power and USB for ten seconds";
  }
  return "";
}

}  // namespace tact::hal::falcon
