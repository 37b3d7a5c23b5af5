// SPDX-License-Identifier: Apache-2.0
#include "host/ros/ros_topics.h"

#include <dds/dds.h>
#include <fmt/format.h>
#include <net/if.h>
#include <ros/messages.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <utility>

#include "model/time_ns.h"

namespace tact::host::ros {
namespace {

using model::Error;
using Header = std_msgs_msg_dds__Header_;
using Pose = geometry_msgs_msg_dds__PoseStamped_;

// One announcement to each participant of this PC: a loopback has no multicast.
constexpr const char* kLoopback =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto"
    "</ParticipantIndex><MaxAutoParticipantIndex>100</MaxAutoParticipantIndex><Peers>"
    "<Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";
constexpr int kMaxServo = 64;      // of one call
constexpr int kMaxWaiting = 1000;  // poses between two reads; of more, the newest

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos qos_of(bool reliable) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  // 0: a reader that does not answer delays nothing.
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, reliable ? 1 : kMaxWaiting);
  return qos;
}

dds_entity_t topic_of(dds_entity_t participant, const std::string& name,
                      const dds_topic_descriptor_t& type) {
  return dds_create_topic(participant, &type, ("rt/" + name).c_str(), nullptr, nullptr);
}

char* plain(const std::string& text) { return const_cast<char*>(text.c_str()); }  // only read

Header header_of(std::int64_t utc_ns, const std::string& frame) {
  const std::int64_t sec = utc_ns / model::kSecond_ns;
  return {.stamp = {.sec = static_cast<std::int32_t>(sec),
                    .nanosec = static_cast<std::uint32_t>(utc_ns - sec * model::kSecond_ns)},
          .frame_id = plain(frame)};
}

Header header_of(const firmware::protocol::LoggedTick& tick, const std::string& frame) {
  return header_of(tick.due_ns + tick.utc.offset_ns, frame);
}

dds_sequence_double sequence_of(const std::array<double, 3>& values) {  // only read
  return {._maximum = 3,
          ._length = 3,
          ._buffer = const_cast<double*>(values.data()),
          ._release = false};
}

template <typename Out>
Out xyz(const model::Vec3& v) {
  return {.x = v.x, .y = v.y, .z = v.z};
}

}  // namespace

RosTopics::~RosTopics() {
  if (domain_ > 0) dds_delete(domain_);  // and all in it
}

std::optional<Error> RosTopics::open(const RosOptions& options) {
  const bool alone = options.interface.empty();
  if (!alone && if_nametoindex(options.interface.c_str()) == 0)
    return Error{fmt::format("--interface {}: this PC has none; take a name of `ip link`",
                             options.interface)};
  const std::string bound = fmt::format(
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"{}\"/></Interfaces>"
      "</General></Domain></CycloneDDS>",
      options.interface);
  const auto domain = static_cast<dds_domainid_t>(options.domain);
  domain_ = dds_create_domain(domain, alone ? kLoopback : bound.c_str());
  participant_ = dds_create_participant(domain, nullptr, nullptr);
  if (participant_ < 0)
    return Error{fmt::format("no DDS on {} ({}); `ip link` says whether it is up",
                             alone ? "lo" : options.interface, dds_strretcode(-participant_))};
  name_ = options.name_space;
  frame_ = options.name_space + "_base";
  std::replace(frame_.begin(), frame_.end(), '/', '_');
  if (make(options.servo)) return std::nullopt;
  return Error{"CycloneDDS makes no topics of " + name_ + "; choose another --namespace"};
}

bool RosTopics::make(bool servo) {
  const Qos fast = qos_of(false), sure = qos_of(true);
  const auto writer = [&](const std::string& name, const dds_topic_descriptor_t& type,
                          const Qos& qos) {
    return dds_create_writer(participant_, topic_of(participant_, name, type), qos.get(), nullptr);
  };
  pose_ = writer(name_ + "/measured_cp", geometry_msgs_msg_dds__PoseStamped__desc, fast);
  twist_ = writer(name_ + "/measured_cv", geometry_msgs_msg_dds__TwistStamped__desc, fast);
  wrench_ = writer(name_ + "/measured_cf", geometry_msgs_msg_dds__WrenchStamped__desc, fast);
  diagnostics_ = writer("diagnostics", diagnostic_msgs_msg_dds__DiagnosticArray__desc, sure);
  if (servo)
    servo_ = dds_create_reader(
        participant_,
        topic_of(participant_, name_ + "/servo_cp", geometry_msgs_msg_dds__PoseStamped__desc),
        fast.get(), nullptr);
  return std::min({pose_, twist_, wrench_, diagnostics_, servo_ + 1}) > 0;
}

void RosTopics::write(const firmware::protocol::LoggedTick& tick) {
  const Header header = header_of(tick, frame_);
  const model::Tool& tool = tick.input.sample.tool;
  const model::Quat& q = tool.orientation;
  const Pose pose{.header = header,
                  .pose = {.position = xyz<geometry_msgs_msg_dds__Point_>(tool.position_m),
                           .orientation = {.x = q.x, .y = q.y, .z = q.z, .w = q.w}}};
  using Vector3 = geometry_msgs_msg_dds__Vector3_;
  const geometry_msgs_msg_dds__TwistStamped_ twist{
      .header = header,
      .twist = {.linear = xyz<Vector3>(tool.velocity_mps),
                .angular = xyz<Vector3>(tool.angular_velocity_radps)}};
  const geometry_msgs_msg_dds__WrenchStamped_ wrench{
      .header = header,
      .wrench = {.force = xyz<Vector3>(tick.output.written.force_N),
                 .torque = xyz<Vector3>(tick.output.written.torque_Nm)}};
  // Best effort: what does not leave is lost, as on any network.
  static_cast<void>(dds_write(pose_, &pose));
  static_cast<void>(dds_write(twist_, &twist));
  static_cast<void>(dds_write(wrench_, &wrench));
}

void RosTopics::write(const firmware::protocol::LoggedTick& tick, const JointState& joints) {
  if (joints_ == 0) {
    joints_ = dds_create_writer(
        participant_,
        topic_of(participant_, name_ + "/joint_states", sensor_msgs_msg_dds__JointState__desc),
        qos_of(false).get(), nullptr);
    if (joints_ < 0)
      fmt::print(stderr, "tact-ros: CycloneDDS makes no {}/joint_states: {}\n", name_,
                 dds_strretcode(-joints_));
  }
  if (joints_ < 0) return;
  static const std::array<std::string, 3> kNames{"arm_1", "arm_2", "arm_3"};
  std::array<char*, 3> names{plain(kNames[0]), plain(kNames[1]), plain(kNames[2])};
  const sensor_msgs_msg_dds__JointState_ out{
      .header = header_of(tick, frame_),
      .name = {._maximum = 3, ._length = 3, ._buffer = names.data(), ._release = false},
      .position = sequence_of(joints.angle_rad),
      .velocity = sequence_of(joints.rate_radps),
      .effort = {}};
  static_cast<void>(dds_write(joints_, &out));
}

void RosTopics::write(const Diagnostic& diagnostic) {
  std::vector<diagnostic_msgs_msg_dds__KeyValue_> values;
  values.reserve(diagnostic.values.size());
  for (const auto& [key, value] : diagnostic.values)
    values.push_back({.key = plain(key), .value = plain(value)});
  const auto count = static_cast<std::uint32_t>(values.size());
  diagnostic_msgs_msg_dds__DiagnosticStatus_ status{
      .level = diagnostic.level,
      .name = plain(name_),
      .message = plain(diagnostic.message),
      .hardware_id = plain(diagnostic.device),
      .values = {._maximum = count, ._length = count, ._buffer = values.data(), ._release = false}};
  const std::chrono::nanoseconds utc = std::chrono::system_clock::now().time_since_epoch();
  const diagnostic_msgs_msg_dds__DiagnosticArray_ all{
      .header = header_of(utc.count(), frame_),
      .status = {._maximum = 1, ._length = 1, ._buffer = &status, ._release = false}};
  static_cast<void>(dds_write(diagnostics_, &all));
}

void RosTopics::read_servo(const std::function<void(const ServoPose&)>& take) {
  std::array<void*, kMaxServo> samples{};
  // NOLINTNEXTLINE(bugprone-invalid-enum-default-initialization): dds_take() writes what is read
  std::array<dds_sample_info_t, kMaxServo> infos{};
  for (int read = 0; servo_ > 0 && read < kMaxWaiting;) {
    const int count = dds_take(servo_, samples.data(), infos.data(), kMaxServo, kMaxServo);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (!infos[i].valid_data) continue;
      const Pose& from = *static_cast<const Pose*>(samples[i]);
      const auto& [p, q] = from.pose;
      take({.frame_id = from.header.frame_id,
            .position_m = {p.x, p.y, p.z},
            .orientation_wxyz = {q.w, q.x, q.y, q.z}});
    }
    static_cast<void>(dds_return_loan(servo_, samples.data(), count));
    read += count;
  }
}

}  // namespace tact::host::ros
