// SPDX-License-Identifier: Apache-2.0
// falcon_device.h - a Novint Falcon as a Device: homing, positions, forces, faults.
//
//     force -> K^T tau = F -> words = -(gain tau + dead band)   (a positive word lowers a thigh)
//
// Zero words with the homing request until all three axes are homed (FP-4); then samples are fresh.
// One command leaves with each write. Without an answer for three ticks of 1 ms the words are zero
// until one comes. Unplugged, stalled, broken, garbled, unhomed or silent devices latch a fault;
// each write after it sends zero words, and stop() too, since a Falcon may hold its last ones for
// ever. Lights: red no force may come, blue ready, green with power.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/falcon/falcon_kinematics.h"
#include "hal/falcon/falcon_pipe.h"
#include "hal/velocity_observer.h"
#include "model/device_settings.h"
#include "model/result.h"
#include "model/units.h"

namespace tact::hal::falcon {

/// Matches reports to commands: each command is answered once, in order. A report without an
/// unanswered command is a repetition. A command older than kLost_ns counts as lost, so a lost
/// answer lets a repetition pass for that long at most.
class FalconExchange {
 public:
  static constexpr std::int64_t kLost_ns = 8'000'000;
  static constexpr std::int64_t kResend_ns = 2'000'000;
  static constexpr std::size_t kMax = 3;  // under way at once; a round trip takes two frames

  /// May a command be sent: few are unanswered, or the oldest is so for too long?
  bool may_send(std::int64_t now_ns) const RT_SAFE {
    return count_ < kMax || now_ns - sent_ns_[first_] >= kResend_ns;
  }
  void sent(std::int64_t now_ns) RT_SAFE {
    if (count_ == kSlots) drop();
    sent_ns_[(first_ + count_++) % kSlots] = now_ns;
  }
  /// How many of these new reports answer a command.
  std::uint64_t answered(std::uint64_t reports, std::int64_t now_ns) RT_SAFE {
    while (count_ > 0 && now_ns - sent_ns_[first_] > kLost_ns) drop();
    std::uint64_t answers = 0;
    for (; answers < reports && count_ > 0; ++answers) drop();
    return answers;
  }

 private:
  static constexpr std::size_t kSlots = 16;
  void drop() RT_SAFE { first_ = (first_ + 1) % kSlots, --count_; }

  std::array<std::int64_t, kSlots> sent_ns_{};  // ring
  std::size_t first_ = 0, count_ = 0;
};

/// What keeps a Falcon from making force. One atomic word: the loop stores it, any thread reads it.
struct alignas(8) FalconTrouble {
  enum class What : std::uint8_t {
    kNone,
    kNotHomed,
    kUnplugged,
    kStalled,
    kBroken,
    kSilent,
    kGarbled,
    kHomingLost,
    kStoodIn,
  };
  What what = What::kNone;
  std::uint8_t homed = 0;        // three bits, axis 1 first
  std::uint8_t line_errors = 0;  // ftdi_requests.h
  std::uint16_t error = 0;       // errno
};
static_assert(std::atomic<FalconTrouble>::is_always_lock_free);

/// One message: which part, why, the remedy; empty for kNone.
std::string text_of(const FalconTrouble& trouble);

class FalconDevice final : public Device {
 public:
  /// A Falcon whose firmware runs.
  FalconDevice(const model::FalconSettings& settings, std::unique_ptr<FalconPipe> pipe);
  ~FalconDevice() override;

  /// Before the loop: where down is for its base, else as for one that lies (hal/mounting.h).
  void set_gravity(const Vec3& gravity_mps2) { gravity_mps2_ = gravity_mps2; }

  DeviceInfo info() const override;
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  bool ready() const RT_SAFE override;
  void permit(bool powered) RT_SAFE override { powered_ = powered; }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  std::span<const int> loop_calls() const override { return pipe_->loop_calls(); }
  std::string trouble() const override;
  std::optional<ShutdownFrames> shutdown_frames() override;
  void stop() override;

  /// What the last write sent; for calibration.
  const FalconWords& words() const RT_SAFE { return words_; }
  Vec3 position_D_m() const RT_SAFE { return position_D_m_; }

 private:
  bool take(const FalconReply& reply, std::int64_t now_ns) RT_SAFE;
  bool follow_homing(const FalconReport& report) RT_SAFE;
  bool locate(const FalconReply& reply) RT_SAFE;
  void check_silence(std::int64_t now_ns) RT_SAFE;
  void check_pipe() RT_SAFE;
  void latch(Fault fault, const FalconTrouble& trouble) RT_SAFE;
  FalconWords words_for(const Vec3& force_W_N) const RT_SAFE;
  FalconCommand command(const FalconWords& words) const RT_SAFE;

  model::FalconSettings settings_;
  Vec3 gravity_mps2_{0.0, 0.0, -model::kGravity_mps2};
  FalconKinematics kinematics_;
  std::unique_ptr<FalconPipe> pipe_;
  FalconExchange exchange_;
  VelocityObserver velocity_;

  Vec3 position_D_m_ = kFalconHome_m;
  Vec3 velocity_W_mps_;
  model::Mat3 rates_{};         // K at position_D_m_; zero makes no force
  FalconWords counts_{};        // of the last good sample
  std::int64_t stamp_ns_ = 0;   // of it; 0: none since homing
  std::uint64_t sequence_ = 0;  // of the last report seen
  std::int64_t now_ns_ = 0;
  std::int64_t heard_ns_ = 0;  // when the last good report was read
  std::uint64_t dropped_before_ = 0;
  std::uint64_t misfits_ = 0;  // reports that cannot be, since the last good one
  int misses_ = 0;             // reads in a row without a good report
  bool homed_ = false, powered_ = true, stopped_ = false;
  FalconWords words_{};
  Fault fault_ = Fault::kNone;
  std::atomic<FalconTrouble> trouble_;
};

}  // namespace tact::hal::falcon
