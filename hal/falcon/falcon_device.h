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
#include <cstdint>
#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/device_facts.h"
#include "hal/falcon/falcon_kinematics.h"
#include "hal/falcon/falcon_pipe.h"
#include "hal/fault_latch.h"
#include "hal/velocity_observer.h"
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
    while (count_ > 0 && now_ns - sent_ns_[first_] > kLost_ns) drop();  // bound: kSlots
    std::uint64_t answers = 0;
    for (; answers < reports && count_ > 0; ++answers) drop();  // bound: kSlots
    return answers;
  }

 private:
  static constexpr std::size_t kSlots = 16;
  void drop() RT_SAFE { first_ = (first_ + 1) % kSlots, --count_; }

  std::array<std::int64_t, kSlots> sent_ns_{};  // ring
  std::size_t first_ = 0, count_ = 0;
};

/// With every product its vendor's number names all FTDI adapters.
inline constexpr UsbPart kFalconParts[] = {
    {.kind = "falcon",
     .vendor = "0403",
     .product = "cb48",
     .name = "Novint Falcon",
     .path_key = "device.falcon.bus_path",
     .rule =
         R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0403", ATTR{idProduct}=="cb48", GROUP="haptics", MODE="0660")",
     .absence =
         "no Novint Falcon (USB 0403:cb48); switch its supply on and plug in its cable (lsusb "
         "shows it)"}};

struct FalconSettings {
  static constexpr Section kSection{"falcon", "a Novint Falcon"};
  using PerAxis = std::array<double, 3>;

  std::string bus_path;         // "1-2.3"; empty: the only one
  std::string firmware_path;    // absolute; empty: its firmware must be running
  std::string firmware_sha256;  // empty: only images that are known
  bool event_character = true;  // the USB chip answers at once, without its 1 ms timer
  bool keep_homing = true;      // the homing request stays set while it runs
  PerAxis gain_words_per_Nm{10'000.0, 10'000.0, 10'000.0};  // by tact-calibrate
  PerAxis dead_band_words{};                                // before an axis moves at all
  double moving_mass_kg = 0.0;  // held up by the motors, at the grip; 0: not held
  double observer_bandwidth_Hz = 40.0;
  double joint_friction_Nm = 0.02, joint_damping_Nms_per_rad = 0.01;

  void visit(model::ParameterVisitor& k) {
    constexpr auto kOptional = model::Need::kOptional;
    k.text("bus_path", "which one, as 1-2.3; empty: the only one", bus_path, kOptional);
    k.file("firmware", "file of the firmware that you own; empty: it runs already", firmware_path,
           kOptional);
    k.text("firmware_sha256", "its digest; empty: only images that are known", firmware_sha256,
           kOptional);
    k.flag("event_character", "answers without the USB chip's 1 ms timer", event_character,
           kOptional);
    k.flag("keep_homing", "the homing request stays set while it runs", keep_homing, kOptional);
    k.per_arm("gain_words_per_Nm", {100.0, 1e6}, "of axis 1, 2, 3, by tact-calibrate",
              gain_words_per_Nm, kOptional);
    k.per_arm("dead_band_words", {0.0, 1000.0}, "before an axis moves, by tact-calibrate",
              dead_band_words, kOptional);
    k.number("moving_mass_kg", {0.0, 1.0}, "at the grip, held up by the motors, by tact-calibrate",
             moving_mass_kg, kOptional);
    k.number("observer_bandwidth_Hz", {1.0, 500.0}, "of the velocity observer",
             observer_bandwidth_Hz, kOptional);
    k.number("joint_friction_Nm", {0.0, 1.0}, "Coulomb friction of a thigh", joint_friction_Nm,
             kOptional);
    k.number("joint_damping_Nms_per_rad", {0.0, 1.0}, "viscous friction of a thigh",
             joint_damping_Nms_per_rad, kOptional);
  }
};

/// What keeps a Falcon from making force: kinds of FaultCause.
enum class FalconCause : std::uint8_t {
  kNone,
  kNotHomed,   // code: homed axes, three bits, axis 1 first
  kUnplugged,  // code: errno, as of the next two
  kStalled,
  kBroken,
  kSilent,
  kGarbled,     // code: line errors (ftdi_requests.h)
  kHomingLost,  // code: homed axes
  kStoodIn,
};

/// One message: which part, why, the remedy; empty for kNone.
std::string text_of(FalconCause cause, std::uint32_t code);

class FalconDevice final : public Device {
 public:
  /// A Falcon whose firmware runs.
  FalconDevice(const FalconSettings& settings, std::unique_ptr<FalconPipe> pipe);
  ~FalconDevice() override;

  /// Before the loop: where down is for its base, else as for one that lies (hal/mounting.h).
  void set_gravity(const Vec3& gravity_mps2) { gravity_mps2_ = gravity_mps2; }

  DeviceInfo info() const override;
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  bool ready() const RT_SAFE override;
  void permit(bool powered) RT_SAFE override { powered_ = powered; }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  std::span<const int> loop_calls() const override { return pipe_->loop_calls(); }
  std::string fault_detail() const override;
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
  Fault fault() const RT_SAFE { return latch_.fault(); }
  void latch(Fault fault, FalconCause cause, std::uint32_t code = 0) RT_SAFE {
    latch_.set({.fault = fault, .kind = static_cast<std::uint8_t>(cause), .code = code});
  }
  void wait_for_homing(std::uint8_t homed) RT_SAFE {
    waits_.set({.kind = static_cast<std::uint8_t>(FalconCause::kNotHomed), .code = homed});
  }
  FalconWords words_for(const Vec3& force_W_N) const RT_SAFE;
  FalconCommand command(const FalconWords& words) const RT_SAFE;

  FalconSettings settings_;
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
  FaultLatch latch_;
  WaitNote waits_;  // for homing
};

}  // namespace tact::hal::falcon
