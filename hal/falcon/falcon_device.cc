// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_device.h"

#include <algorithm>
#include <cmath>

#include "hal/falcon/falcon_at_tool.h"
#include "hal/falcon/falcon_boot.h"
#include "hal/falcon/falcon_kinematics.h"
#include "model/units.h"

namespace tact::hal::falcon {
namespace {

constexpr double kDeadBandRamp_words = 20.0;  // a force near zero does not chatter
// Silent means both: in a loop above 1 kHz an answer takes several ticks.
constexpr int kSilentTicks = 3;
constexpr std::int64_t kSilent_ns = 2'500'000;    // 3 ticks of 1 ms, with their jitter
constexpr std::int64_t kGarbled_ns = 17'000'000;  // named before the gate gives up at 20 ticks
constexpr std::int64_t kMute_ns = 500'000'000;    // whether anyone is armed or not
constexpr int kMuteTicks = 20;
constexpr double kMaxCounts_per_s = 250e3;  // 6 m/s where the counts are finest
constexpr double kMaxCountsAtOnce = 250.0;  // 1 ms of it: a stamp may be a USB frame off
constexpr FalconCommand kLastCommand{.lights = kFalconRed};
constexpr int kLastCommands = 3;  // whether the first has come is not reported

bool is_pressed(const FalconReport& report, std::uint8_t button) RT_SAFE {
  return (report.buttons & button) != 0;
}

}  // namespace

FalconDevice::FalconDevice(const FalconSettings& settings, std::unique_ptr<FalconPipe> pipe)
    : settings_(settings),
      pipe_(std::move(pipe)),
      velocity_(settings.observer_bandwidth_Hz, kJump_mps) {
  wait_for_homing(0);
}

FalconDevice::~FalconDevice() { stop(); }

DeviceInfo FalconDevice::info() const {
  return {.name = "Novint Falcon",
          .max_force_N = falcon_max_force_N(kinematics_, settings_),
          .max_torque_Nm = 0.0,
          .workspace_radius_m = kFalconRadius_m,
          .workspace_half_length_m = kFalconHalfLength_m,
          .grip = GripKind::kButton,
          .at_tool = falcon_at_tool(kinematics_, settings_),
          .damping_key = "device.falcon.joint_damping_Nms_per_rad"};
}

Fault FalconDevice::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  sample.fresh = false;
  now_ns_ = now_ns;
  if (stopped_) return fault();
  if (heard_ns_ == 0) heard_ns_ = now_ns;  // silence begins with the loop
  check_pipe();
  FalconReply reply;
  if (fault() == Fault::kNone && pipe_->newest(reply) && take(reply, now_ns)) {
    sample.tool = {.position_m = falcon_point_W(position_D_m_),
                   .velocity_mps = velocity_W_mps_,
                   .grip_ratio = is_pressed(reply.report, kFalconCentre) ? 1.0 : 0.0};
    sample.stamp_ns = reply.stamp_ns;
    sample.sequence = reply.sequence;
    sample.fresh = true;
  }
  check_silence(now_ns);
  return fault();
}

/// A new sample of a homed device that answers a command in time.
bool FalconDevice::take(const FalconReply& reply, std::int64_t now_ns) RT_SAFE {
  const std::uint64_t answers = exchange_.answered(reply.sequence - sequence_, now_ns);
  sequence_ = reply.sequence;
  if (answers == 0) return false;
  const bool homed = follow_homing(reply.report);
  if (fault() != Fault::kNone) return false;
  // Before homing the counts mean nothing; afterwards a report must be one that a hand can make.
  if (homed && !locate(reply)) {
    ++misfits_;
    return false;
  }
  heard_ns_ = now_ns;
  misses_ = -1;  // this read is none
  misfits_ = 0;
  dropped_before_ = pipe_->health().dropped_bytes;
  return homed;
}

bool FalconDevice::follow_homing(const FalconReport& report) RT_SAFE {
  const bool homed = report.all_homed();
  if (homed_ && !homed) latch(Fault::kHomingLost, FalconCause::kHomingLost, report.homed);
  if (homed_ || fault() != Fault::kNone) return homed;
  if (!homed) return wait_for_homing(report.homed), false;
  waits_.clear();
  homed_ = true;  // the counts jump with it; nothing was believed before
  return true;
}

/// Where the grip is; false for counts that no hand can make, or no pose has.
bool FalconDevice::locate(const FalconReply& reply) RT_SAFE {
  const double elapsed_s = 1e-9 * static_cast<double>(reply.stamp_ns - stamp_ns_);
  delta::Joints thigh_rad{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int counts = reply.report.counts[i];
    thigh_rad[i] = falcon_thigh_rad(counts);
    if (stamp_ns_ != 0 &&
        std::abs(counts - counts_[i]) > kMaxCountsAtOnce + kMaxCounts_per_s * elapsed_s)
      return false;
  }
  FalconForward forward = kinematics_.forward(thigh_rad, position_D_m_);
  // After a gap the last place may be too far for Newton; home is not (falcon_kinematics.h).
  if (!forward.solved) forward = kinematics_.forward(thigh_rad, kFalconHome_m);
  if (!forward.solved) return false;
  position_D_m_ = forward.position_m;
  rates_ = kinematics_.joint_rate_matrix(kinematics_.inverse(position_D_m_));
  velocity_W_mps_ = velocity_.step(falcon_point_W(position_D_m_), elapsed_s);
  counts_ = reply.report.counts;
  stamp_ns_ = reply.stamp_ns;
  return true;
}

void FalconDevice::check_silence(std::int64_t now_ns) RT_SAFE {
  ++misses_;
  if (fault() != Fault::kNone || misses_ < kSilentTicks) return;
  const FalconPipeHealth health = pipe_->health();
  const std::int64_t silence_ns = now_ns - heard_ns_;
  // Who sends rubbish is named as garbled, before the longer silence would name it mute.
  const bool babbles = misfits_ > 0 || health.dropped_bytes != dropped_before_;
  if (babbles && silence_ns >= kGarbled_ns)
    latch(Fault::kDeviceGarbled, FalconCause::kGarbled, health.line_errors);
  if (silence_ns >= kMute_ns && misses_ >= kMuteTicks)
    latch(Fault::kDeviceLost, FalconCause::kSilent);
}

void FalconDevice::check_pipe() RT_SAFE {
  const FalconPipeHealth health = pipe_->health();
  const auto error = static_cast<std::uint32_t>(health.error);
  // The hand has had zero force since; what the gate would go on with is the force from before.
  if (health.stood_in) return latch(Fault::kLoopStalled, FalconCause::kStoodIn);
  switch (health.end) {
    case FalconPipeEnd::kOpen:
      return;
    case FalconPipeEnd::kUnplugged:
      return latch(Fault::kDeviceUnplugged, FalconCause::kUnplugged, error);
    case FalconPipeEnd::kStalled:
      return latch(Fault::kDeviceFailed, FalconCause::kStalled, error);
    case FalconPipeEnd::kBroken:
      return latch(Fault::kDeviceFailed, FalconCause::kBroken, error);
  }
}

/// A short silence takes nothing from it: that is the gate's to evaluate.
bool FalconDevice::ready() const RT_SAFE {
  return homed_ && powered_ && !stopped_ && fault() == Fault::kNone && stamp_ns_ != 0;
}

Fault FalconDevice::write(const Wrench& wrench) RT_SAFE {
  if (stopped_) return fault();
  const bool sound = is_finite(wrench.force_N);
  const bool silent = misses_ >= kSilentTicks && now_ns_ - heard_ns_ >= kSilent_ns;
  words_ = ready() && !silent ? words_for(sound ? wrench.force_N : Vec3{}) : FalconWords{};
  if (fault() != Fault::kNone || exchange_.may_send(now_ns_)) {  // zeros wait for no answer
    if (pipe_->submit(encode(command(words_))))
      exchange_.sent(now_ns_);
    else
      check_pipe();  // gone is known in this tick; full is a missed cycle
  }
  if (fault() != Fault::kNone) return fault();
  return sound ? Fault::kNone : Fault::kForceNotFinite;
}

/// tau = tau_gravity + s K^-T F, one s for all axes; then words.
FalconWords FalconDevice::words_for(const Vec3& force_W_N) const RT_SAFE {
  const Vec3 held_N = -settings_.moving_mass_kg * gravity_mps2_;
  const delta::Joints held_Nm = falcon_torques_Nm(rates_, falcon_direction_D(held_N));
  const delta::Joints wanted_Nm = falcon_torques_Nm(rates_, falcon_direction_D(force_W_N));
  delta::Joints held{}, wanted{};  // 1 is all that an axis can do
  for (std::size_t i = 0; i < 3; ++i) {
    // The dead band takes its words first: only the rest makes torque.
    const double most_words = kFalconMotorMax - settings_.dead_band_words[i];
    const double per_Nm = settings_.gain_words_per_Nm[i] / most_words;
    held[i] = per_Nm * held_Nm[i];
    wanted[i] = per_Nm * wanted_Nm[i];
  }
  // In shares of each axis, as the axes have different limits in N m.
  const double ratio = delta::saturation_ratio(held, wanted, 1.0);
  std::array<double, 3> words{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double torque_Nm = held_Nm[i] + ratio * wanted_Nm[i];
    const double useful_words = settings_.gain_words_per_Nm[i] * torque_Nm;
    const double share = std::clamp(useful_words / kDeadBandRamp_words, -1.0, 1.0);
    words[i] = -(useful_words + settings_.dead_band_words[i] * share);
  }
  return falcon_motor_words(words);
}

FalconCommand FalconDevice::command(const FalconWords& words) const RT_SAFE {
  const bool ready = homed_ && fault() == Fault::kNone;
  const std::uint8_t light = !ready ? kFalconRed : powered_ ? kFalconGreen : kFalconBlue;
  // FP-4: sources disagree whether a Falcon forgets its home without the bit: a setting.
  return {.motor = words, .lights = light, .homing = !homed_ || settings_.keep_homing};
}

std::string FalconDevice::fault_detail() const {
  const FaultCause cause = fault() != Fault::kNone ? latch_.cause() : waits_.cause();
  return text_of(static_cast<FalconCause>(cause.kind), cause.code);
}

std::optional<ShutdownFrames> FalconDevice::shutdown_frames() {
  const std::array<ShutdownFrames::Bytes, 1> zero{encode(kLastCommand)};
  ShutdownFrames frames{.carrier = ShutdownFrames::Carrier::kUsbBulk,
                        .endpoint = kFalconEndpointOut,
                        .fd = pipe_->descriptor()};
  bool fits = frames.fd >= 0;
  for (int i = 0; i < kLastCommands && fits; ++i) fits = frames.add_step(zero);
  return fits ? std::optional(frames) : std::nullopt;
}

void FalconDevice::stop() {
  if (stopped_) return;
  stopped_ = true;
  words_ = {};
  // StopAndDelete and the destructor both call it: the pipe is stopped once.
  pipe_->stop(encode(kLastCommand));
}

}  // namespace tact::hal::falcon
