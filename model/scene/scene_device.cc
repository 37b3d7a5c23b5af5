// SPDX-License-Identifier: Apache-2.0
// The keys of [device]: every device's own section, and the safety lines.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/scene/scene_keys.h"

namespace tact::model::scene {
namespace {

/// A whole number that may be negative.
void visit_whole(Keys& k, std::string_view key, Range range, const char* meaning, int& out) {
  // Keys::count knows no number below zero; a number that must be whole is asked afterwards.
  double value = out;
  k.number(key, range, meaning, value, kOptional);
  if (value != std::floor(value)) k.refuse({key}, std::string(key) + " takes a whole number");
  out = static_cast<int>(value);
}

/// Required, all of them: a simulated device that is perfect by
/// default would hide what a real one cannot show.
void visit_sim(Keys& k, SimDeviceSettings& sim) {
  k.number("counts_per_turn", {100.0, 1e8}, "encoder counts of one turn of a joint",
           sim.counts_per_turn);
  k.number("sample_delay_s", {0.0, 0.005}, "age of a sample when the loop gets it",
           sim.sample_delay_s);
  k.number("joint_friction_Nm", {0.0, 1.0}, "Coulomb friction of each joint",
           sim.joint_friction_Nm);
  k.number("joint_damping_Nms_per_rad", {0.0, 1.0}, "viscous friction of each joint",
           sim.joint_damping_Nms_per_rad);
  k.number("observer_bandwidth_Hz", {1.0, 500.0}, "of the velocity observer",
           sim.observer_bandwidth_Hz);
}

/// Required: with another device's arm length or mass every force is wrong.
void visit_delta(Keys& k, DeltaSettings& d) {
  k.number("base_radius_m", {0.01, 1.0}, "motor axes from the middle", d.base_radius_m);
  k.number("platform_radius_m", {0.0, 1.0}, "rod ends from the middle of the platform",
           d.platform_radius_m);
  k.number("upper_arm_m", {0.01, 1.0}, "motor axis to elbow", d.upper_arm_m);
  k.number("forearm_m", {0.01, 2.0}, "elbow to platform", d.forearm_m);
  k.per_arm("azimuth_rad", {-6.3, 6.3}, "of arms 1, 2, 3 about the device's axis", d.azimuth_rad);
  k.number("theta_min_rad", {-3.2, 3.2}, "lower stop of an arm", d.theta_min_rad);
  k.number("theta_max_rad", {-3.2, 3.2}, "upper stop of an arm", d.theta_max_rad);
  k.number("arm_kg", {0.0, 10.0}, "one upper arm", d.arm_kg);
  k.number("arm_com_m", {0.0, 1.0}, "its centre of mass from the motor axis", d.arm_com_m);
  k.number("arm_inertia_kgm2", {0.0, 1.0}, "its inertia about the motor axis", d.arm_inertia_kgm2);
  k.number("rotor_inertia_kgm2", {0.0, 0.1}, "of one motor", d.rotor_inertia_kgm2);
  k.number("gear_ratio", {1.0, 200.0}, "motor turns per turn of an arm", d.gear_ratio);
  k.number("forearm_kg", {0.0, 10.0}, "both rods of one arm", d.forearm_kg);
  k.number("platform_kg", {0.0, 10.0}, "platform and handle", d.platform_kg);
  k.number("middle_m", {0.01, 2.0}, "plane of the motors to the origin of W", d.middle_m);
  k.number("workspace_radius_m", {0.01, 1.0}, "of the cylinder it may reach", d.workspace_radius_m);
  k.number("workspace_half_length_m", {0.01, 1.0}, "of that cylinder", d.workspace_half_length_m);
  k.number("max_force_N", {0.1, 100.0}, "what it can show without pause", d.max_force_N);
  k.number("max_joint_torque_Nm", {0.01, 100.0}, "of one arm", d.max_joint_torque_Nm);
  k.number("joint_friction_Nm", {0.0, 1.0}, "Coulomb friction of an arm", d.joint_friction_Nm);
  k.number("joint_damping_Nms_per_rad", {0.0, 1.0}, "viscous friction of an arm",
           d.joint_damping_Nms_per_rad);
  k.number("counts_per_turn", {100.0, 1e8}, "encoder counts of one turn of an arm",
           d.counts_per_turn);
  k.number("observer_bandwidth_Hz", {1.0, 500.0}, "of the velocity observer",
           d.observer_bandwidth_Hz, kOptional);
}

void visit_nodes(Keys& k, CanSettings& can) {
  PerArm node{};
  for (std::size_t i = 0; i < node.size(); ++i) node[i] = can.node[i];
  // A CANopen drive has node 1 to 126, an ODrive 0 to 63: each device refuses the rest by itself.
  k.per_arm("node", {0.0, 127.0}, "of the drives of arms 1, 2, 3", node, kOptional);
  bool is_whole = true;
  for (std::size_t i = 0; i < node.size(); ++i) {
    can.node[i] = static_cast<int>(node[i]);
    is_whole = is_whole && can.node[i] == node[i];
  }
  if (!is_whole || node[0] == node[1] || node[1] == node[2] || node[2] == node[0])
    k.refuse({"node"}, "device.can.node needs three different whole numbers, as [1, 2, 3]");
}

/// What one kind of drives takes, another would leave aside without a word: a current that nobody
/// limits.
void refuse_foreign_keys(Keys& k, std::string_view kind, const CanSettings& can) {
  const auto refuse = [&](std::string_view key, std::string_view owner) {
    k.refuse({key}, fmt::format("device.can.{} is for {}, and a {} would not take it; remove it",
                                key, owner, kind));
  };
  const bool on_can = kind.starts_with("can-");
  if (on_can && kind != "can-odrive" && can.max_current_A != 0.0)
    refuse("max_current_A", "an ODrive");
  if (on_can && kind != "can-cia402" && can.rated_torque_Nm != 0.0)
    refuse("rated_torque_Nm", "a CiA 402 drive");
  if (on_can && kind != "can-cia402" && can.command_at_sync)
    refuse("command_at_sync", "a CiA 402 drive");
}

void visit_can(Keys& k, DeviceSettings& device) {
  CanSettings& can = device.can;
  constexpr std::array kHoming{Choice{"absolute", "absolute encoders, zero_turns holds for good"},
                               Choice{"index", "the drives look for the index pulse at start"},
                               Choice{"jig", "the arms rest at home_rad when tactd starts"}};
  static_assert(kHoming.size() == static_cast<std::size_t>(Homing::kJig) + 1);
  k.text("interface", "of the bus, as ip link shows it", can.interface, kOptional);
  visit_nodes(k, can);
  k.choice("homing", kHoming, "how the arms' angles are known", can.homing);
  // Each homing needs one of the two; describing has no homing yet.
  const bool on_jig = can.homing == Homing::kJig;
  k.per_arm("zero_turns", {-1e6, 1e6}, "of the motors, arms at 0 rad; the jig finds it",
            can.zero_turns, on_jig ? kOptional : Need::kRequired);
  k.per_arm("direction", {-1.0, 1.0}, "1 or -1: sign of a motor's turn for a rising arm",
            can.direction);
  if (std::ranges::any_of(can.direction, [](double sign) { return std::abs(sign) != 1.0; }))
    k.refuse({"direction"}, "device.can.direction takes 1 or -1 for each arm");
  k.per_arm("home_rad", {-3.2, 3.2}, "of the arms on the jig; \"jig\" alone needs it", can.home_rad,
            on_jig ? Need::kRequired : kOptional);
  k.number("max_velocity_turns_per_s", {0.0, 1000.0}, "of an ODrive's motor; 0: the drive's own",
           can.max_velocity_turns_per_s, kOptional);
  k.number("max_current_A", {0.0, 200.0}, "of an ODrive's motor; 0: the drive's own",
           can.max_current_A, kOptional);
  if ((can.max_velocity_turns_per_s == 0.0) != (can.max_current_A == 0.0))
    k.refuse({"max_velocity_turns_per_s", "max_current_A"},
             "device.can needs both max_velocity_turns_per_s and max_current_A, or none: an ODrive "
             "takes them in one message");
  k.flag("short_torque", "ODrive: torque in 4 bytes, 32 us less on the bus", can.short_torque,
         kOptional);
  k.number("counts_per_motor_turn", {100.0, 1e8}, "increments of a CiA 402 drive",
           can.counts_per_motor_turn, kOptional);
  k.flag("command_at_sync", "CiA 402: torque waits for SYNC, if the drive insists",
         can.command_at_sync, kOptional);
  k.number("rated_torque_Nm", {0.0, 1000.0}, "CiA 402: of a motor; 0: as the drive tells (6076)",
           can.rated_torque_Nm, kOptional);
  refuse_foreign_keys(k, device.kind, can);
}

void visit_falcon(Keys& k, FalconSettings& f) {
  k.text("bus_path", "which one, as 1-2.3; empty: the only one", f.bus_path, kOptional);
  k.text("firmware", "file of the firmware that you own; empty: it runs already", f.firmware_path,
         kOptional);
  k.text("firmware_sha256", "its digest; empty: only images that are known", f.firmware_sha256,
         kOptional);
  k.flag("event_character", "answers without the USB chip's 1 ms timer", f.event_character,
         kOptional);
  k.flag("keep_homing", "the homing request stays set while it runs", f.keep_homing, kOptional);
  k.per_arm("gain_words_per_Nm", {100.0, 1e6}, "of axis 1, 2, 3, by tact-calibrate",
            f.gain_words_per_Nm, kOptional);
  k.per_arm("dead_band_words", {0.0, 1000.0}, "before an axis moves, by tact-calibrate",
            f.dead_band_words, kOptional);
  k.number("moving_mass_kg", {0.0, 1.0}, "at the grip, held up by the motors, by tact-calibrate",
           f.moving_mass_kg, kOptional);
  k.number("observer_bandwidth_Hz", {1.0, 500.0}, "of the velocity observer",
           f.observer_bandwidth_Hz, kOptional);
  k.number("joint_friction_Nm", {0.0, 1.0}, "Coulomb friction of a thigh", f.joint_friction_Nm,
           kOptional);
  k.number("joint_damping_Nms_per_rad", {0.0, 1.0}, "viscous friction of a thigh",
           f.joint_damping_Nms_per_rad, kOptional);
}

void visit_force_dimension(Keys& k, ForceDimensionSettings& f) {
  k.text("library", "the vendor's, by name or path", f.library, kOptional);
  visit_whole(k, "id", {-1.0, 15.0}, "of the device, -1: the only one", f.id);
  // FD-3: the device counts 255 units of 125 us at most.
  k.number("watchdog_s", {0.001, 0.0318}, "without a force for so long the device lets go",
           f.watchdog_s, kOptional);
  k.number("effector_mass_kg", {0.0, 5.0}, "0: the vendor's value", f.effector_mass_kg, kOptional);
  k.number("damping_Ns_per_m", {0.0, 50.0}, "that the device has at the handle", f.damping_Ns_per_m,
           kOptional);
  k.number("gripper_open_rad", {0.0, 1.6}, "of its gripper, fully open; 0: the vendor's value",
           f.gripper_open_rad, kOptional);
}

void visit_phantom(Keys& k, PhantomSettings& p) {
  k.text("library", "the vendor's, by name or path", p.library, kOptional);
  k.text("name", "that the vendor's Touch_Setup gave it; empty: the default device", p.name,
         kOptional);
  k.number("damping_Ns_per_m", {0.0, 50.0}, "that the device has at the stylus", p.damping_Ns_per_m,
           kOptional);
  k.number("position_step_m", {1e-6, 1e-3}, "of its encoders, at the stylus", p.position_step_m,
           kOptional);
}

void visit_line(Keys& k, std::string_view key, const char* meaning, int& offset) {
  visit_whole(k, key, {-1.0, 511.0}, meaning, offset);
}

/// -1, the default of each: that line is not wired.
void visit_lines(Keys& k, LinesSettings& lines) {
  k.text("chip", "label of the GPIO chip, as gpiodetect shows it, or its path", lines.chip,
         kOptional);
  visit_line(k, "estop_a", "in, high = good, channel A of the e-stop; -1: none", lines.estop_a);
  visit_line(k, "estop_b", "in, high = good, channel B", lines.estop_b);
  visit_line(k, "dead_man", "in, high = held", lines.dead_man);
  visit_line(k, "grip", "in, a foot or hand switch that closes the jaws", lines.grip);
  constexpr std::array kGripLevels{Choice{"high", "the jaws close at the high level"},
                                   Choice{"low", "at the low level"}};
  k.choice("grip_closes", kGripLevels, "polarity of the grip line", lines.grip_closes_low,
           kOptional);
  visit_line(k, "clutch", "in, high = pressed: the tool stays, the handle moves", lines.clutch);
  visit_line(k, "enable", "out, high = the drives may have power", lines.enable);
  visit_line(k, "heartbeat", "out, toggles after every healthy tick", lines.heartbeat);
  visit_line(k, "led", "out, high = armed", lines.led);
  visit_line(k, "scope", "out, high from wake to write", lines.scope);
  // One channel could fail unseen (RT-16).
  if ((lines.estop_a < 0) != (lines.estop_b < 0))
    k.refuse({"estop_a", "estop_b"},
             "device.lines needs both channels of the e-stop, estop_a and estop_b, or none");
}

}  // namespace

void visit_device(Keys& k, DeviceSettings& out) {
  k.text("kind", "sim-delta is the simulated device; tactd --list-devices", out.kind);
  k.vector("base_orientation_deg", {-360.0, 360.0},
           "turn of its base, axis times angle; 0: axis towards you", out.base_orientation_deg,
           kOptional);
  k.vector("base_position_m", {-0.5, 0.5}, "where the middle of its workspace is, in W",
           out.base_position_m, kOptional);
  k.number("motion_scale", {0.1, 10.0}, "way of the tool for a way of the handle", out.motion_scale,
           kOptional);
  // Without a kind, as where the reference is written, the simulated device is the one to show.
  const bool simulated = out.kind.empty() || out.kind == "sim-delta";
  k.section("sim", "imperfections of the simulated device", visit_sim, out.sim,
            simulated ? Need::kRequired : kOptional);
  const Need on_can = out.is_on_can() ? Need::kRequired : kOptional;
  k.section("delta", "a delta on CAN: yours, as you measure it", visit_delta, out.delta, on_can);
  k.section("can", "its drives, can-odrive, can-cia402 or can-moteus", visit_can, out, on_can);
  k.section("falcon", "a Novint Falcon", visit_falcon, out.falcon, kOptional);
  k.section("force_dimension", "a Force Dimension device, by its vendor's SDK",
            visit_force_dimension, out.force_dimension, kOptional);
  k.section("phantom", "a PHANTOM or 3D Systems Touch, by its vendor's SDK", visit_phantom,
            out.phantom, kOptional);
  k.section("lines", "safety lines", visit_lines, out.lines, kOptional);
}

}  // namespace tact::model::scene
