// SPDX-License-Identifier: Apache-2.0
// What a node of ROS 2 would do (peer.h), by Fast DDS and the code that fastddsgen makes of
// messages.idl.
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "messagesPubSubTypes.h"
#include "tests/host/ros/peer.h"

namespace tact::tests::ros {
namespace {

using namespace eprosima::fastdds::dds;
using namespace geometry_msgs::msg::dds_;
using sensor_msgs::msg::dds_::JointState_, sensor_msgs::msg::dds_::JointState_PubSubType;

Values values_of(const PoseStamped_& from) {
  const auto& p = from.pose().position();
  const auto& q = from.pose().orientation();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}
template <typename Vector>
Values six(const Vector& a, const Vector& b) {
  return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), 0.0};
}
Values values_of(const TwistStamped_& from) {
  return six(from.twist().linear(), from.twist().angular());
}
Values values_of(const WrenchStamped_& from) {
  return six(from.wrench().force(), from.wrench().torque());
}
Values values_of(const JointState_& from) {
  return joint_values(from.name(), from.position(), from.velocity(), from.effort().size());
}

template <typename Message>
int take_all(DataReader* reader, std::uint8_t topic) {
  int got = 0;
  Message message;
  SampleInfo info;
  while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    const auto& stamp = message.header().stamp();
    write_record({topic, stamp.sec(), stamp.nanosec(), values_of(message)});
    ++got;
  }
  return got;
}

class FastDds {
 public:
  explicit FastDds(DomainId_t domain)
      : participant_(DomainParticipantFactory::get_instance()->create_participant(
            domain, PARTICIPANT_QOS_DEFAULT)) {}
  bool good() const { return participant_ != nullptr; }

  void open_readers() {
    const std::array types{
        TypeSupport(new PoseStamped_PubSubType()), TypeSupport(new TwistStamped_PubSubType()),
        TypeSupport(new WrenchStamped_PubSubType()), TypeSupport(new JointState_PubSubType())};
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = BEST_EFFORT_RELIABILITY_QOS;
    qos.history().kind = KEEP_ALL_HISTORY_QOS;
    qos.resource_limits().max_samples = 100000;
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      readers_[i] = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
                        ->create_datareader(topic_of(types[i], kTopics[i]), qos);
  }
  bool has_writer(std::size_t topic) const {
    SubscriptionMatchedStatus matched;
    return readers_[topic]->get_subscription_matched_status(matched) == ReturnCode_t::RETCODE_OK &&
           matched.current_count > 0;
  }
  int take(std::uint8_t topic) {
    constexpr std::array kTake{take_all<PoseStamped_>, take_all<TwistStamped_>,
                               take_all<WrenchStamped_>, take_all<JointState_>};
    return kTake[topic](readers_[topic], topic);
  }

  void open_writer() {
    writer_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT)
                  ->create_datawriter(topic_of(TypeSupport(new PoseStamped_PubSubType()), kServo),
                                      DATAWRITER_QOS_DEFAULT);
  }
  bool has_reader() const {
    PublicationMatchedStatus matched;
    return writer_->get_publication_matched_status(matched) != ReturnCode_t::RETCODE_OK ||
           matched.current_count > 0;
  }
  void write(const Pose& from) {
    const auto& v = from.values;
    PoseStamped_ pose;
    pose.header().frame_id(from.frame);
    auto& p = pose.pose().position();
    p.x(v[0]), p.y(v[1]), p.z(v[2]);
    auto& q = pose.pose().orientation();
    q.w(v[3]), q.x(v[4]), q.y(v[5]), q.z(v[6]);
    writer_->write(&pose);
  }

 private:
  Topic* topic_of(TypeSupport type, const char* name) {
    type.register_type(participant_);
    return participant_->create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT);
  }

  DomainParticipant* participant_;
  std::array<DataReader*, kTopics.size()> readers_{};
  DataWriter* writer_ = nullptr;
};

}  // namespace
}  // namespace tact::tests::ros

int main(int argc, char** argv) {
  return tact::tests::ros::run_peer<tact::tests::ros::FastDds>(argc, argv);
}
