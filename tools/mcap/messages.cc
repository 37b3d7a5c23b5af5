// SPDX-License-Identifier: Apache-2.0
#include "tools/mcap/messages.h"

#include <algorithm>
#include <limits>

namespace tact::tools::mcap {
namespace {

using firmware::telemetry::Frame;
using firmware::telemetry::LoggedTick;

constexpr const char* kFrameId = "tact_device";
constexpr std::uint64_t kSecond_ns = 1'000'000'000;

// A message, then what it is made of, each behind a line of 80 signs.
#define TACT_PART(name)                                                                          \
  "================================================================================\nMSG: " name \
  "\n"
#define TACT_HEADER                                             \
  TACT_PART("std_msgs/Header")                                  \
  "builtin_interfaces/Time stamp\nstring frame_id\n" TACT_PART( \
      "builtin_interfaces/Time") "int32 sec\nuint32 nanosec\n"

constexpr const char* kPose =
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n" TACT_HEADER TACT_PART("geometry_msgs/Pose")
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
    TACT_PART("geometry_msgs/Point") "float64 x\nfloat64 y\nfloat64 z\n"
    TACT_PART("geometry_msgs/Quaternion") "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
constexpr const char* kWrench =
    "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n" TACT_HEADER
    TACT_PART("geometry_msgs/Wrench") "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n"
    TACT_PART("geometry_msgs/Vector3") "float64 x\nfloat64 y\nfloat64 z\n";
constexpr const char* kState =
    "std_msgs/Header header\n"
    "uint64 tick\n"
    "uint8 STATE_OFF=0\nuint8 STATE_READY=1\nuint8 STATE_ARMED=2\nuint8 STATE_STOPPED=3\n"
    "uint8 state\n"
    "bool non_rt  # no hard real time\n"
    "uint16 fault  # tactd --faults; 0 none\n"
    "uint16 limit  # of the last stage that acted; same table\n"
    "float64 margin_us  # time left before the deadline\n"
    "float64 grip_ratio  # 0 open, 1 closed\n"
    "float64 rms_force_newton\n"
    "float64 given_energy_joule\n"
    "uint64 contact_losses  # so far\n" TACT_HEADER;

#undef TACT_HEADER
#undef TACT_PART

Cdr stamped(std::uint64_t time_ns) {
  // ROS has int32 seconds: a damaged time stays in range.
  const std::uint64_t most_s = std::numeric_limits<std::int32_t>::max();
  Cdr out;
  out.put(static_cast<std::uint32_t>(std::min(time_ns / kSecond_ns, most_s)));
  out.put(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  out.text(kFrameId);
  return out;
}

void put(Cdr& out, const double (&v)[3]) {
  for (const double value : v) out.real(value);
}

void set(double (&to)[3], const model::Vec3& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

}  // namespace

const Schema& pose_schema() {
  static constexpr Schema kSchema{"geometry_msgs/msg/PoseStamped", "ros2msg", kPose, "cdr"};
  return kSchema;
}
const Schema& wrench_schema() {
  static constexpr Schema kSchema{"geometry_msgs/msg/WrenchStamped", "ros2msg", kWrench, "cdr"};
  return kSchema;
}
const Schema& state_schema() {
  // Ours: no message of ROS has state, fault and margin.
  static constexpr Schema kSchema{"tact_msgs/msg/State", "ros2msg", kState, "cdr"};
  return kSchema;
}

Moment Moment::of(const LoggedTick& tick, std::uint64_t time_ns) {
  const model::Tool& tool = tick.input.sample.tool;
  const firmware::loop::TickOutput& o = tick.output;
  Moment out{.time_ns = time_ns,
             .rotation_wxyz = {tool.orientation.w, tool.orientation.x, tool.orientation.y,
                               tool.orientation.z},
             .written = {},
             .wanted = {},
             .tick = tick.tick,
             .state = static_cast<std::uint8_t>(o.state),
             .non_rt = tick.non_rt,
             .fault = static_cast<std::uint16_t>(o.fault),
             .limit = static_cast<std::uint16_t>(o.limit),
             .margin_us = 1e-3 * static_cast<double>(tick.margin_ns),
             .grip_ratio = tool.grip_ratio,
             .rms_force_N = o.rms_force_N,
             .given_energy_J = o.given_energy_J,
             .contact_losses = o.contact_losses};
  set(out.position_m, tool.position_m);
  set(out.written.force_N, o.written.force_N);
  set(out.written.torque_Nm, o.written.torque_Nm);
  set(out.wanted.force_N, o.wanted.force_N);
  set(out.wanted.torque_Nm, o.wanted.torque_Nm);
  return out;
}

Moment Moment::of(const Frame& frame, std::uint64_t time_ns) {
  Moment out{.time_ns = time_ns,
             .written = {},
             .wanted = {},
             .tick = frame.tick,
             .state = static_cast<std::uint8_t>(frame.state),
             .non_rt = frame.non_rt,
             .fault = frame.fault,
             .limit = frame.limit,
             // A frame has the worst of its ticks; a tick has its own.
             .margin_us = frame.worst_margin_us,
             .grip_ratio = frame.grip_ratio,
             .rms_force_N = frame.rms_force_N,
             .given_energy_J = frame.given_energy_J,
             .contact_losses = frame.contact_losses};
  std::ranges::copy(frame.tool_position_m, out.position_m);
  std::ranges::copy(frame.tool_orientation, out.rotation_wxyz);
  std::ranges::copy(frame.force_N, out.written.force_N);
  std::ranges::copy(frame.torque_Nm, out.written.torque_Nm);
  std::ranges::copy(frame.wanted_force_N, out.wanted.force_N);
  // A frame does not tell it: NaN, as zero would be a claim.
  std::ranges::fill(out.wanted.torque_Nm, std::numeric_limits<double>::quiet_NaN());
  return out;
}

std::string pose_message(const Moment& moment) {
  Cdr out = stamped(moment.time_ns);
  put(out, moment.position_m);
  const auto& [w, x, y, z] = moment.rotation_wxyz;
  // ROS writes w last.
  return out.real(x).real(y).real(z).real(w).str();
}

std::string wrench_message(const Moment& moment, const Wrench& wrench) {
  Cdr out = stamped(moment.time_ns);
  put(out, wrench.force_N);
  put(out, wrench.torque_Nm);
  return out.str();
}

std::string state_message(const Moment& moment) {
  // In the order of kState: CDR has no names.
  return stamped(moment.time_ns)
      .put(moment.tick)
      .put(moment.state)
      .put(static_cast<std::uint8_t>(moment.non_rt != 0 ? 1 : 0))
      .put(moment.fault)
      .put(moment.limit)
      .real(moment.margin_us)
      .real(moment.grip_ratio)
      .real(moment.rms_force_N)
      .real(moment.given_energy_J)
      .put(moment.contact_losses)
      .str();
}

}  // namespace tact::tools::mcap
