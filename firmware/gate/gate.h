// gate.h - the one way from the model to the device. Every force passes every stage, in this order:
//
//   finite     NaN or infinity: zero, latches
//   fresh      one missed sample holds, from the second the force fades to zero in 10 ms, 20 latch
//   armed      zero unless the supervisor says armed
//   workspace  outside the permitted cylinder the force fades to zero in 50 ms
//   magnitude  |F| and |T| as vectors
//   slew       |dF| and |dT| per tick
//   ramp       fades in after arming
//
// Each stage has a reason code (model/fault.h) and a counter. Saturates and fades, never cuts to
// zero in one step unless stopped. Speed, passivity and power join this list where DESIGN 5 puts
// them.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/gate/fader.h"
#include "firmware/gate/limiter.h"
#include "hal/device.h"
#include "model/fault.h"
#include "model/scene.h"
#include "model/types.h"

namespace tact::firmware {

using model::Fault;
using model::Wrench;

enum class Stage : std::uint8_t {
  kFinite,
  kFresh,
  kArmed,
  kWorkspace,
  kMagnitude,
  kSlew,
  kRamp,
};
inline constexpr std::size_t kStageCount = 7;
inline constexpr std::array<const char*, kStageCount> kStageName{
    "finite", "fresh", "armed", "workspace", "magnitude", "slew", "ramp"};

/// What holds for this scene on this device: the smaller of the two, everywhere.
model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device);

struct GateInput {
  Wrench wanted;
  Vec3 position_m;  // of the tool, W
  bool fresh = false;
  bool armed = false;
};

struct GateVerdict {
  Wrench wrench;               // to the device
  Fault limit = Fault::kNone;  // the last stage that acted, 1..99
  Fault fault = Fault::kNone;  // 100+: the supervisor must stop
};

class Gate {
 public:
  /// `force_share` scales the magnitude limits: 0.25 on a PC without hard real time.
  Gate(const model::Limits& limits, double period_s, double force_share);

  GateVerdict judge(const GateInput& input) RT_SAFE;
  /// How often each stage acted.
  const std::array<std::uint64_t, kStageCount>& counters() const RT_SAFE { return counter_; }
  double force_limit_N() const RT_SAFE { return force_limit_N_; }

 private:
  void note(Stage stage, Fault reason, GateVerdict& verdict) RT_SAFE;
  void check_fresh(const GateInput& input, GateVerdict& verdict) RT_SAFE;
  bool inside_workspace(const Vec3& position_m) const RT_SAFE;
  void limit(GateVerdict& verdict) RT_SAFE;
  void let_go() RT_SAFE;

  double period_s_;
  double force_limit_N_, torque_limit_Nm_;
  double force_step_N_, torque_step_Nm_;  // slew per tick, less the room that the ramp needs
  double workspace_radius_m_, workspace_half_length_m_;
  Fader fresh_, workspace_, ramp_;
  std::uint32_t missed_ = 0;  // samples in a row
  Wrench before_;             // after slew, before ramp
  std::array<std::uint64_t, kStageCount> counter_{};
};

}  // namespace tact::firmware
