// SPDX-License-Identifier: Apache-2.0
// What a node of ROS 2 would do (peer.h), by CycloneDDS.
#include <dds/dds.h>
#include <ros/messages.h>

#include <cstring>
#include <span>

#include "tests/host/ros/peer.h"

namespace tact::tests::ros {
namespace {

dds_qos_t* qos_of(dds_reliability_kind_t reliability) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliability, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  return qos;
}

Values plain(const auto& from) {
  Values out{};
  std::memcpy(out.data(), &from, sizeof from);
  return out;
}
Values values_of(const geometry_msgs_msg_dds__PoseStamped_& from) { return plain(from.pose); }
Values values_of(const geometry_msgs_msg_dds__TwistStamped_& from) { return plain(from.twist); }
Values values_of(const geometry_msgs_msg_dds__WrenchStamped_& from) { return plain(from.wrench); }
Values values_of(const sensor_msgs_msg_dds__JointState_& from) {
  const auto span_of = [](const auto& s) { return std::span(s._buffer, s._length); };
  return joint_values(span_of(from.name), span_of(from.position), span_of(from.velocity),
                      from.effort._length);
}

template <typename Message>
void write_sample(std::uint8_t topic, const void* sample) {
  const auto& message = *static_cast<const Message*>(sample);
  const auto& stamp = message.header.stamp;
  write_record({topic, stamp.sec, stamp.nanosec, values_of(message)});
}

class Cyclone {
 public:
  explicit Cyclone(dds_domainid_t domain)
      : participant_(dds_create_participant(domain, nullptr, nullptr)) {}
  ~Cyclone() { dds_delete(participant_); }
  Cyclone(const Cyclone&) = delete;
  Cyclone& operator=(const Cyclone&) = delete;
  bool good() const { return participant_ > 0; }

  void open_readers() {
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      readers_[i] = dds_create_reader(participant_, topic_of(*kTypes[i], kTopics[i]),
                                      qos_of(DDS_RELIABILITY_BEST_EFFORT), nullptr);
  }
  bool has_writer(std::size_t topic) const {
    dds_subscription_matched_status_t matched{};
    return dds_get_subscription_matched_status(readers_[topic], &matched) == 0 &&
           matched.current_count > 0;
  }
  int take(std::uint8_t topic) {
    void* samples[64] = {};
    dds_sample_info_t infos[64];
    const int taken = dds_take(readers_[topic], samples, infos, 64, 64);
    int got = 0;
    for (int n = 0; n < taken; ++n) {
      if (!infos[n].valid_data) continue;
      kWrite[topic](topic, samples[n]);
      ++got;
    }
    if (taken > 0) dds_return_loan(readers_[topic], samples, taken);
    return got;
  }

  void open_writer() {
    writer_ =
        dds_create_writer(participant_, topic_of(geometry_msgs_msg_dds__PoseStamped__desc, kServo),
                          qos_of(DDS_RELIABILITY_RELIABLE), nullptr);
  }
  bool has_reader() const {
    dds_publication_matched_status_t matched{};
    return dds_get_publication_matched_status(writer_, &matched) != 0 || matched.current_count > 0;
  }
  void write(Pose pose) {
    const auto& v = pose.values;
    geometry_msgs_msg_dds__PoseStamped_ out{};
    out.header.frame_id = pose.frame.data();
    out.pose.position = {v[0], v[1], v[2]};
    out.pose.orientation = {v[4], v[5], v[6], v[3]};
    dds_write(writer_, &out);
  }

 private:
  static constexpr std::array kTypes{
      &geometry_msgs_msg_dds__PoseStamped__desc, &geometry_msgs_msg_dds__TwistStamped__desc,
      &geometry_msgs_msg_dds__WrenchStamped__desc, &sensor_msgs_msg_dds__JointState__desc};
  static constexpr std::array kWrite{write_sample<geometry_msgs_msg_dds__PoseStamped_>,
                                     write_sample<geometry_msgs_msg_dds__TwistStamped_>,
                                     write_sample<geometry_msgs_msg_dds__WrenchStamped_>,
                                     write_sample<sensor_msgs_msg_dds__JointState_>};

  dds_entity_t topic_of(const dds_topic_descriptor_t& type, const char* name) const {
    return dds_create_topic(participant_, &type, name, nullptr, nullptr);
  }

  dds_entity_t participant_, writer_ = 0;
  std::array<dds_entity_t, kTopics.size()> readers_{};
};

}  // namespace
}  // namespace tact::tests::ros

int main(int argc, char** argv) {
  return tact::tests::ros::run_peer<tact::tests::ros::Cyclone>(argc, argv);
}
