// SPDX-License-Identifier: Apache-2.0
// device_settings.h - what a scene says about the device and the lines beside it.
//
// Plain numbers and names; what they mean to a device is said in hal/. What only the owner of a
// device can know has no default: a scene must name it (model/scene/scene_device.cc). Other
// defaults are those of the vendors' manuals. Set-up code only.
#pragma once

#include <array>
#include <string>

#include "model/types.h"

namespace tact::model {

using PerArm = std::array<double, 3>;  // one value an arm or its motor, 1 to 3

/// The simulated Delta's imperfections; its geometry is fixed in hal/sim.
struct SimDeviceSettings {
  double counts_per_turn = 0.0;            // of a joint
  double sample_delay_s = 0.0;             // age of a sample when the loop gets it
  double joint_friction_Nm = 0.0;          // Coulomb, per joint
  double joint_damping_Nms_per_rad = 0.0;  // viscous, per joint
  double observer_bandwidth_Hz = 0.0;      // of the velocity observer
};

/// A delta of one's own, on its side: its z axis points at the operator (types.h, frame W).
struct DeltaSettings {
  double base_radius_m = 0.0;      // shoulder axes
  double platform_radius_m = 0.0;  // ends of the rods
  double upper_arm_m = 0.0;
  double forearm_m = 0.0;
  PerArm azimuth_rad{};
  double theta_min_rad = 0.0, theta_max_rad = 0.0;  // stops of an arm
  double arm_kg = 0.0, arm_com_m = 0.0, arm_inertia_kgm2 = 0.0;
  double rotor_inertia_kgm2 = 0.0;
  double gear_ratio = 0.0;   // motor turns per turn of an arm
  double forearm_kg = 0.0;   // both rods of one arm
  double platform_kg = 0.0;  // with the handle
  double middle_m = 0.0;     // origin of W, from the plane of the motors
  double workspace_radius_m = 0.0, workspace_half_length_m = 0.0;
  double max_force_N = 0.0;
  double max_joint_torque_Nm = 0.0;
  double joint_friction_Nm = 0.0;          // Coulomb
  double joint_damping_Nms_per_rad = 0.0;  // viscous, what the device really has
  double counts_per_turn = 0.0;            // of an arm
  double observer_bandwidth_Hz = 40.0;
};

/// How a delta on CAN knows its arms' angles.
enum class Homing {
  kAbsolute,  // absolute encoders: zero_turns holds for good
  kIndex,     // the drives turn to the index pulse at start, then zero_turns holds
  kJig,       // the arms rest on a jig at home_rad when tactd starts
};

/// Three drives on one bus.
struct CanSettings {
  std::string interface = "can0";
  std::array<int, 3> node{1, 2, 3};
  Homing homing = Homing::kJig;
  PerArm zero_turns{};  // of the motor, where the arm is at 0 rad
  PerArm direction{};   // 1 or -1: sign of the motor's turn for a rising arm
  PerArm home_rad{};    // of the arms on the jig
  // ODrive
  double max_velocity_turns_per_s = 0.0;  // of the motor, where the drive gives up
  double max_current_A = 0.0;             // both or none; 0: the drive's own limits stay
  bool short_torque = true;               // 4 bytes of torque, not 8: 32 us less on the bus
  // CiA 402
  double counts_per_motor_turn = 10'000.0;
  bool command_at_sync = false;  // RPDO type 1, if the drive insists
  double rated_torque_Nm = 0.0;  // what 1000 of object 6071 are; 0: the drive's own 6076
};

struct FalconSettings {
  std::string bus_path;         // "1-2.3"; empty: the only one
  std::string firmware_path;    // absolute; empty: its firmware must be running
  std::string firmware_sha256;  // empty: only images that are known
  bool event_character = true;  // the USB chip answers at once, without its 1 ms timer
  bool keep_homing = true;      // the homing request stays set while it runs
  PerArm gain_words_per_Nm{10'000.0, 10'000.0, 10'000.0};  // by tact-calibrate
  PerArm dead_band_words{};                                // before an axis moves at all
  double moving_mass_kg = 0.0;  // held up by the motors, at the grip; 0: not held
  double observer_bandwidth_Hz = 40.0;
  double joint_friction_Nm = 0.02, joint_damping_Nms_per_rad = 0.01;
};

struct ForceDimensionSettings {
  std::string library = "libdhd.so.3";  // name or path; the vendor's, never part of tact
  int id = -1;                          // -1: the only device
  double watchdog_s = 0.004;            // the device lets go by itself; at most 0.0318
  double effector_mass_kg = 0.0;        // 0: the vendor's value
  double damping_Ns_per_m = 1.0;        // what the device itself has, at the handle
  double gripper_open_rad = 0.0;        // its gripper, fully open; 0: the vendor's value
};

struct PhantomSettings {
  std::string library = "libHD.so";  // name or path; the vendor's, never part of tact
  std::string name;                 // that the vendor's Touch_Setup gave; empty: the default device
  double damping_Ns_per_m = 1.0;    // what the device itself has, at the stylus
  double position_step_m = 5.5e-5;  // of its encoders, at the stylus
};

/// Lines of one GPIO chip, by offset; -1: not wired.
struct LinesSettings {
  std::string chip;  // label or path; empty: no lines
  int estop_a = -1, estop_b = -1;
  int dead_man = -1;
  int enable = -1, heartbeat = -1, led = -1, scope = -1;
  int grip = -1;                 // foot or hand switch that closes the jaws
  bool grip_closes_low = false;  // at the low level; else at the high one
  int clutch = -1;               // switch that parts tool and handle
  bool wired() const { return !chip.empty(); }
};

struct DeviceSettings {
  std::string kind;             // "sim-delta", or another that hal/registry knows
  Vec3 base_orientation_deg{};  // turn of its base, axis times angle; 0: as hal/ draws it
  Vec3 base_position_m{};       // of its base, W
  double motion_scale = 1.0;    // way of the tool for a way of the handle
  bool trust_library = false;  // the vendor's may be anybody's file; a person says so, no scene can
  SimDeviceSettings sim{};
  DeltaSettings delta{};
  CanSettings can{};
  FalconSettings falcon{};
  ForceDimensionSettings force_dimension{};
  PhantomSettings phantom{};
  LinesSettings lines{};

  bool is_on_can() const { return kind.starts_with("can-"); }
};

}  // namespace tact::model
