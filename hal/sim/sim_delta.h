// SPDX-License-Identifier: Apache-2.0
// sim_delta.h - a haptic device that needs no hardware: delta, wrist, hand, encoders and delay.
//
// What a loop would meet on the real thing: positions counted by joint encoders and shown some time
// later, velocity from the shared observer, forces turned into joint torques and held until the
// next write, saturation that keeps the direction of the force, gravity that the device balances by
// itself from the pose it has measured. Physics runs in between_ticks in steps of at most 0.25 ms.
// The same calls give the same bits: it reads no clock and no random number.
#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "hal/delta/delta_kinematics.h"
#include "hal/device.h"
#include "hal/device_facts.h"
#include "hal/mounting.h"
#include "hal/sim/delta_plant.h"
#include "hal/sim/hand_target.h"
#include "hal/sim/sim_hand.h"
#include "hal/sim/sim_wrist.h"
#include "hal/threads/latest_slot.h"
#include "hal/velocity_observer.h"
#include "model/result.h"

namespace tact::hal::sim {

/// Faults for tests; may be set from any thread.
struct SimFaults {
  std::atomic<int> drop_samples{0};         // so many reads find nothing fresh
  std::atomic<bool> nan_sample{false};      // positions are NaN while set
  std::atomic<Fault> device{Fault::kNone};  // read and write return this while set
};

/// Its imperfections; its geometry is in sim_delta_model.h. Required, all of them: a simulated
/// device that is perfect by default would hide what a real one cannot show.
struct SimDeviceSettings {
  static constexpr Section kSection{"sim", "imperfections of the simulated device", true};

  double counts_per_turn = 0.0;            // of a joint
  double sample_delay_s = 0.0;             // age of a sample when the loop gets it
  double joint_friction_Nm = 0.0;          // Coulomb, per joint
  double joint_damping_Nms_per_rad = 0.0;  // viscous, per joint
  double observer_bandwidth_Hz = 0.0;      // of the velocity observer
  bool is_ideal = false;                   // no device: counts on the damping of its hand, too

  void visit(model::ParameterVisitor& k) {
    k.number("counts_per_turn", {100.0, 1e8, model::kHard}, "encoder counts of one turn of a joint",
             counts_per_turn);
    k.number("sample_delay_s", {0.0, 0.005, model::kHard}, "age of a sample when the loop gets it",
             sample_delay_s);
    k.number("joint_friction_Nm", {0.0, 1.0, model::kHard}, "Coulomb friction of each joint",
             joint_friction_Nm);
    k.number("joint_damping_Nms_per_rad", {0.0, 1.0, model::kHard},
             "viscous friction of each joint", joint_damping_Nms_per_rad);
    k.number("observer_bandwidth_Hz", {1.0, 500.0, model::kHard}, "of the velocity observer",
             observer_bandwidth_Hz);
  }
};

/// sim-ideal, to look at a scene: with the damping of its hand it bears 40 kN/m at 1 kHz.
inline constexpr SimDeviceSettings kIdeal{.counts_per_turn = 1e8,
                                          .joint_damping_Nms_per_rad = 1.0,
                                          .observer_bandwidth_Hz = 500.0,
                                          .is_ideal = true};

class SimDelta final : public Device {
 public:
  /// Settings as checked by make_sim_delta().
  /// Targets of the hand are in W. The base has the pose of `mounting`, and MountedDevice rotates
  /// the samples; the orientation of the handle is the scene's.
  SimDelta(const SimDeviceSettings& device, const model::HandSettings& hand,
           const Mounting& mounting = {});

  DeviceInfo info() const override;
  [[nodiscard]] Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override;
  void set_grip_force(double opening_N) RT_SAFE override { wanted_grip_N_ = opening_N; }
  [[nodiscard]] Fault write(const Wrench& wrench) RT_SAFE override;
  void permit(bool powered) RT_SAFE override { permitted_ = powered; }
  bool ready() const RT_SAFE override { return permitted_; }
  void shift_tool(const Vec3& shift_m) RT_SAFE override { tool_shift_m_ = shift_m; }
  void between_ticks(double elapsed_s) RT_SAFE override;
  void stop() override;

  /// For the thread that receives steering (hand_socket.h).
  threads::LatestSlot<HandTarget>& hand_targets() { return hand_targets_; }
  SimFaults& faults() { return faults_; }
  /// The truth behind the encoders, in the axes of its base.
  const DeltaPlant& plant() const { return plant_; }
  const SimHand& hand() const { return hand_; }
  /// On its fingers, opening positive; the hand holds their gap.
  double grip_force_N() const { return grip_N_; }
  Vec3 true_position_W_m() const RT_SAFE;

 private:
  struct State {  // what the encoders could see at one time
    double time_s = 0.0;
    delta::Joints theta_rad{};
    Vec3 wrist_rad;
    double grip_ratio = 0.0, grip_rate_per_s = 0.0;
  };
  static constexpr std::size_t kHistory = 1024;  // 0.1 s of steps of 0.1 ms

  State state_now() const RT_SAFE;
  State state_at(double time_s) const RT_SAFE;
  const State& remembered(std::size_t steps_ago) const RT_SAFE;
  void steer_hand() RT_SAFE;
  void step_physics(double dt_s) RT_SAFE;
  bool measure(const State& state, Tool& tool) RT_SAFE;

  SimDeviceSettings settings_;
  Mounting mounting_;
  Vec3 gravity_D_mps2_;
  delta::DeltaKinematics delta_;
  SimHand hand_;
  DeltaPlant plant_;
  SimWrist wrist_;
  VelocityObserver velocity_, angular_velocity_;

  std::array<State, kHistory> history_;  // ring
  std::size_t newest_ = 0;
  double time_s_ = 0.0;
  double shown_s_;             // time of the state that the last sample showed
  delta::DeltaPose measured_;  // of the last sample
  delta::Joints motor_Nm_{};   // held until the next write
  Vec3 wrist_Nm_;
  Vec3 tool_shift_m_;      // from the handle, by the clutch
  Vec3 steering_shift_m_;  // the same, when steering began
  double wanted_grip_N_ = 0.0, grip_N_ = 0.0;
  double grip_rate_per_s_ = 0.0;  // of the hand
  bool powered_ = true;           // until stop()
  bool permitted_ = true;         // by the safety lines, in this tick
  std::uint64_t sequence_ = 0;
  threads::LatestSlot<HandTarget> hand_targets_;
  SimFaults faults_;
};

/// Refuses settings that no device can have.
model::Result<std::unique_ptr<SimDelta>> make_sim_delta(SimDeviceSettings device,
                                                        const model::HandSettings& hand,
                                                        const Mounting& mounting = {});

}  // namespace tact::hal::sim
