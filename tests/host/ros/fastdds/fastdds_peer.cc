// SPDX-License-Identifier: Apache-2.0
// What a node of ROS 2 would do, by Fast DDS and the code that fastddsgen makes of messages.idl.
//
//     fastdds_peer DOMAIN read COUNT   writes records of three topics, until each has COUNT
//     fastdds_peer DOMAIN servo        writes each line FRAME x y z qw qx qy qz as a pose
//
// Once tact-ros is found: "matched", on standard error or output.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>

#include "messagesPubSubTypes.h"

namespace {

using namespace eprosima::fastdds::dds;
using namespace geometry_msgs::msg::dds_;

#pragma pack(push, 1)
struct Record {
  std::uint8_t topic;
  std::int32_t sec;
  std::uint32_t nanosec;
  std::array<double, 7> values;
};
#pragma pack(pop)

std::array<double, 7> values_of(const PoseStamped_& from) {
  const auto& p = from.pose().position();
  const auto& q = from.pose().orientation();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}
template <typename Pair>
std::array<double, 7> six(const Pair& a, const Pair& b) {
  return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), 0.0};
}
std::array<double, 7> values_of(const TwistStamped_& from) {
  return six(from.twist().linear(), from.twist().angular());
}
std::array<double, 7> values_of(const WrenchStamped_& from) {
  return six(from.wrench().force(), from.wrench().torque());
}

DataReader* reader_of(DomainParticipant& participant, TypeSupport type, const char* name) {
  type.register_type(&participant);
  Topic* topic = participant.create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT);
  DataReaderQos qos = DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = BEST_EFFORT_RELIABILITY_QOS;
  qos.history().kind = KEEP_ALL_HISTORY_QOS;
  qos.resource_limits().max_samples = 100000;
  return participant.create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
}

template <typename Message>
int take(DataReader* reader, std::uint8_t topic) {
  int got = 0;
  Message message;
  SampleInfo info;
  while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    const auto& stamp = message.header().stamp();
    const Record record{topic, stamp.sec(), stamp.nanosec(), values_of(message)};
    got += static_cast<int>(std::fwrite(&record, sizeof record, 1, stdout));
  }
  return got;
}

int read(DomainParticipant& participant, int count) {
  DataReader* pose =
      reader_of(participant, TypeSupport(new PoseStamped_PubSubType()), "rt/tact/measured_cp");
  DataReader* twist =
      reader_of(participant, TypeSupport(new TwistStamped_PubSubType()), "rt/tact/measured_cv");
  DataReader* wrench =
      reader_of(participant, TypeSupport(new WrenchStamped_PubSubType()), "rt/tact/measured_cf");
  const std::array readers{pose, twist, wrench};
  const auto has_writer = [](DataReader* reader) {
    SubscriptionMatchedStatus matched;
    return reader->get_subscription_matched_status(matched) == ReturnCode_t::RETCODE_OK &&
           matched.current_count > 0;
  };
  while (!std::all_of(readers.begin(), readers.end(), has_writer)) usleep(1000);
  std::fprintf(stderr, "matched\n");
  std::array<int, 3> got{};
  while (*std::min_element(got.begin(), got.end()) < count) {
    usleep(1000);
    got[0] += take<PoseStamped_>(pose, 0);
    got[1] += take<TwistStamped_>(twist, 1);
    got[2] += take<WrenchStamped_>(wrench, 2);
  }
  return 0;
}

int servo(DomainParticipant& participant) {
  TypeSupport type(new PoseStamped_PubSubType());
  type.register_type(&participant);
  Topic* topic =
      participant.create_topic("rt/tact/servo_cp", type.get_type_name(), TOPIC_QOS_DEFAULT);
  DataWriter* writer = participant.create_publisher(PUBLISHER_QOS_DEFAULT)
                           ->create_datawriter(topic, DATAWRITER_QOS_DEFAULT);
  PublicationMatchedStatus matched;
  while (writer->get_publication_matched_status(matched) == ReturnCode_t::RETCODE_OK &&
         matched.current_count == 0)
    usleep(1000);
  std::printf("matched\n");
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string frame;
    std::array<double, 7> v{};
    words >> frame;
    for (double& value : v) {
      std::string word;
      words >> word;
      value = std::strtod(word.c_str(), nullptr);  // of nan and inf, too
    }
    PoseStamped_ pose;
    pose.header().frame_id(frame == "-" ? "" : frame);
    auto& p = pose.pose().position();
    p.x(v[0]), p.y(v[1]), p.z(v[2]);
    auto& q = pose.pose().orientation();
    q.w(v[3]), q.x(v[4]), q.y(v[5]), q.z(v[6]);
    writer->write(&pose);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  DomainParticipant* participant = DomainParticipantFactory::get_instance()->create_participant(
      static_cast<DomainId_t>(std::atoi(argv[1])), PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) return 2;
  const bool reads = std::string_view(argv[2]) == "read" && argc == 4;
  const int status = reads ? read(*participant, std::atoi(argv[3])) : servo(*participant);
  std::fflush(stdout);
  return status;
}
