// SPDX-License-Identifier: Apache-2.0
// can_settings.h - settings of a self-built delta with three drives on one bus.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "hal/delta/delta_dynamics.h"
#include "hal/device_facts.h"
#include "model/device_settings.h"

namespace tact::hal::can {

using PerArm = delta::Joints;  // one value an arm or its motor, 1 to 3

/// On its side: its z axis points at the operator (model/types.h, frame W). Required: with another
/// device's arm length or mass every force is wrong.
struct DeltaSettings : delta::DeltaGeometry, delta::DeltaMasses {
  static constexpr Section kSection{"delta", "a delta on CAN: yours, as you measure it", true};

  double middle_m = 0.0;  // origin of W, from the plane of the motors
  double workspace_radius_m = 0.0, workspace_half_length_m = 0.0;
  double max_force_N = 0.0;
  double max_joint_torque_Nm = 0.0;
  double joint_friction_Nm = 0.0;          // Coulomb
  double joint_damping_Nms_per_rad = 0.0;  // viscous, what the device really has
  double counts_per_turn = 0.0;            // of an arm
  double observer_bandwidth_Hz = 40.0;

  void visit(model::ParameterVisitor& k) {
    k.number("base_radius_m", {0.01, 1.0}, "motor axes from the middle", base_radius_m);
    k.number("platform_radius_m", {0.0, 1.0}, "rod ends from the middle of the platform",
             platform_radius_m);
    k.number("upper_arm_m", {0.01, 1.0}, "motor axis to elbow", upper_arm_m);
    k.number("forearm_m", {0.01, 2.0}, "elbow to platform", forearm_m);
    k.per_arm("azimuth_rad", {-6.3, 6.3}, "of arms 1, 2, 3 about the device's axis", azimuth_rad);
    k.number("theta_min_rad", {-3.2, 3.2}, "lower stop of an arm", theta_min_rad);
    k.number("theta_max_rad", {-3.2, 3.2}, "upper stop of an arm", theta_max_rad);
    k.number("arm_kg", {0.0, 10.0}, "one upper arm", arm_kg);
    k.number("arm_com_m", {0.0, 1.0}, "its centre of mass from the motor axis", arm_com_m);
    k.number("arm_inertia_kgm2", {0.0, 1.0}, "its inertia about the motor axis", arm_inertia_kgm2);
    k.number("rotor_inertia_kgm2", {0.0, 0.1}, "of one motor", rotor_inertia_kgm2);
    k.number("gear_ratio", {1.0, 200.0}, "motor turns per turn of an arm", gear_ratio);
    k.number("forearm_kg", {0.0, 10.0}, "both rods of one arm", forearm_kg);
    k.number("platform_kg", {0.0, 10.0}, "platform and handle", platform_kg);
    k.number("middle_m", {0.01, 2.0}, "plane of the motors to the origin of W", middle_m);
    k.number("workspace_radius_m", {0.01, 1.0}, "of the cylinder it may reach", workspace_radius_m);
    k.number("workspace_half_length_m", {0.01, 1.0}, "of that cylinder", workspace_half_length_m);
    k.number("max_force_N", {0.1, 100.0}, "what it can show without pause", max_force_N);
    k.number("max_joint_torque_Nm", {0.01, 100.0}, "of one arm", max_joint_torque_Nm);
    k.number("joint_friction_Nm", {0.0, 1.0}, "Coulomb friction of an arm", joint_friction_Nm);
    k.number("joint_damping_Nms_per_rad", {0.0, 1.0}, "viscous friction of an arm",
             joint_damping_Nms_per_rad);
    k.number("counts_per_turn", {100.0, 1e8}, "encoder counts of one turn of an arm",
             counts_per_turn);
    k.number("observer_bandwidth_Hz", {1.0, 500.0}, "of the velocity observer",
             observer_bandwidth_Hz, model::Need::kOptional);
  }
};

/// How a delta on CAN knows its arms' angles.
enum class Homing {
  kAbsolute,  // absolute encoders: zero_turns holds for good
  kIndex,     // the drives turn to the index pulse at start, then zero_turns holds
  kJig,       // the arms rest on a jig at home_rad when tactd starts
};

/// Three drives on one bus. What one kind of drives alone takes is in its folder.
struct CanSettings {
  static constexpr Section kSection{"can", "its drives, can-odrive, can-cia402 or can-moteus",
                                    true};

  std::string interface = "can0";
  std::array<int, 3> node{1, 2, 3};
  Homing homing = Homing::kJig;
  PerArm zero_turns{};  // of the motor, where the arm is at 0 rad
  PerArm direction{};   // 1 or -1: sign of the motor's turn for a rising arm
  PerArm home_rad{};    // of the arms on the jig

  void visit(model::ParameterVisitor& k) {
    using model::Choice;
    constexpr std::array kHoming{Choice{"absolute", "absolute encoders, zero_turns holds for good"},
                                 Choice{"index", "the drives look for the index pulse at start"},
                                 Choice{"jig", "the arms rest at home_rad when tactd starts"}};
    static_assert(kHoming.size() == static_cast<std::size_t>(Homing::kJig) + 1);
    k.text("interface", "of the bus, as ip link shows it", interface, model::Need::kOptional);
    visit_nodes(k);
    k.choice("homing", kHoming, "how the arms' angles are known", homing);
    // Each homing needs one of the two; describing has no homing yet.
    const bool on_jig = homing == Homing::kJig;
    k.per_arm("zero_turns", {-1e6, 1e6}, "of the motors, arms at 0 rad; the jig finds it",
              zero_turns, on_jig ? model::Need::kOptional : model::Need::kRequired);
    k.per_arm("direction", {-1.0, 1.0}, "1 or -1: sign of a motor's turn for a rising arm",
              direction);
    if (std::ranges::any_of(direction, [](double sign) { return std::abs(sign) != 1.0; }))
      k.refuse({"direction"}, "device.can.direction takes 1 or -1 for each arm");
    k.per_arm("home_rad", {-3.2, 3.2}, "of the arms on the jig; \"jig\" alone needs it", home_rad,
              on_jig ? model::Need::kRequired : model::Need::kOptional);
  }

 private:
  void visit_nodes(model::ParameterVisitor& k) {
    PerArm given{};
    std::ranges::copy(node, given.begin());
    // A CANopen drive has node 1 to 126, an ODrive 0 to 63: each device refuses the rest by itself.
    k.per_arm("node", {0.0, 127.0}, "of the drives of arms 1, 2, 3", given, model::Need::kOptional);
    std::ranges::transform(given, node.begin(), [](double one) { return static_cast<int>(one); });
    if (!std::ranges::equal(given, node) || node[0] == node[1] || node[1] == node[2] ||
        node[2] == node[0])
      k.refuse({"node"}, "device.can.node needs three different whole numbers, as [1, 2, 3]");
  }
};

inline bool is_on_can(const model::DeviceSettings& device) {
  return device.kind.starts_with("can-");
}

/// Refuses a key in [device.can] that another kind of drives has: it would be ignored in silence,
/// as a current limit.
inline void refuse_of_others(model::ParameterVisitor& k, const model::DeviceSettings& device,
                             std::string_view kind, std::string_view key, std::string_view owner) {
  if (is_on_can(device) && device.kind != kind)
    k.refuse({key}, fmt::format("device.can.{} is for {}, and a {} would not take it; remove it",
                                key, owner, device.kind));
}

}  // namespace tact::hal::can
