// SPDX-License-Identifier: Apache-2.0
// What a node of ROS 2 would do, by CycloneDDS; fastdds/fastdds_peer.cc has the same command line.
//
//     cyclone_peer DOMAIN read COUNT   writes records of three topics, until each has COUNT
//     cyclone_peer DOMAIN servo        writes each line FRAME x y z qw qx qy qz as a pose
//
// Once tact-ros is found: "matched", on standard error or output.
#include <dds/dds.h>
#include <ros/messages.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>

namespace {

#pragma pack(push, 1)
struct Record {
  std::uint8_t topic;
  std::int32_t sec;
  std::uint32_t nanosec;
  double values[7];
};
#pragma pack(pop)

dds_qos_t* qos_of(dds_reliability_kind_t reliability) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliability, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  return qos;
}

Record record_of(std::uint8_t topic, const void* sample) {
  const auto make = [topic](const std_msgs_msg_dds__Header_& header, const auto& values) {
    Record out{.topic = topic, .sec = header.stamp.sec, .nanosec = header.stamp.nanosec, .values{}};
    std::memcpy(out.values, &values, sizeof values);
    return out;
  };
  if (topic == 0) {
    const auto& pose = *static_cast<const geometry_msgs_msg_dds__PoseStamped_*>(sample);
    return make(pose.header, pose.pose);
  }
  if (topic == 1) {
    const auto& twist = *static_cast<const geometry_msgs_msg_dds__TwistStamped_*>(sample);
    return make(twist.header, twist.twist);
  }
  const auto& wrench = *static_cast<const geometry_msgs_msg_dds__WrenchStamped_*>(sample);
  return make(wrench.header, wrench.wrench);
}

int read(dds_entity_t participant, int count) {
  const std::array types{&geometry_msgs_msg_dds__PoseStamped__desc,
                         &geometry_msgs_msg_dds__TwistStamped__desc,
                         &geometry_msgs_msg_dds__WrenchStamped__desc};
  const std::array names{"rt/tact/measured_cp", "rt/tact/measured_cv", "rt/tact/measured_cf"};
  std::array<dds_entity_t, 3> readers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto topic = dds_create_topic(participant, types[i], names[i], nullptr, nullptr);
    readers[i] =
        dds_create_reader(participant, topic, qos_of(DDS_RELIABILITY_BEST_EFFORT), nullptr);
  }
  const auto has_writer = [](dds_entity_t reader) {
    dds_subscription_matched_status_t matched{};
    return dds_get_subscription_matched_status(reader, &matched) == 0 && matched.current_count > 0;
  };
  while (!std::all_of(readers.begin(), readers.end(), has_writer)) usleep(1000);
  std::fprintf(stderr, "matched\n");
  std::array<int, 3> got{};
  while (*std::min_element(got.begin(), got.end()) < count) {
    usleep(1000);
    for (std::uint8_t i = 0; i < 3; ++i) {
      void* samples[64] = {};
      dds_sample_info_t infos[64];
      const int taken = dds_take(readers[i], samples, infos, 64, 64);
      for (int n = 0; n < taken; ++n) {
        const Record record = record_of(i, samples[n]);
        if (infos[n].valid_data && std::fwrite(&record, sizeof record, 1, stdout) == 1) ++got[i];
      }
      if (taken > 0) dds_return_loan(readers[i], samples, taken);
    }
  }
  return 0;
}

int servo(dds_entity_t participant) {
  const auto topic = dds_create_topic(participant, &geometry_msgs_msg_dds__PoseStamped__desc,
                                      "rt/tact/servo_cp", nullptr, nullptr);
  const auto writer =
      dds_create_writer(participant, topic, qos_of(DDS_RELIABILITY_RELIABLE), nullptr);
  dds_publication_matched_status_t matched{};
  while (dds_get_publication_matched_status(writer, &matched) == 0 && matched.current_count == 0)
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
    if (frame == "-") frame.clear();
    geometry_msgs_msg_dds__PoseStamped_ pose{};
    pose.header.frame_id = frame.data();
    pose.pose.position = {v[0], v[1], v[2]};
    pose.pose.orientation = {v[4], v[5], v[6], v[3]};
    dds_write(writer, &pose);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(std::atoi(argv[1])), nullptr, nullptr);
  if (participant < 0) return 2;
  const bool reads = std::string_view(argv[2]) == "read" && argc == 4;
  const int status = reads ? read(participant, std::atoi(argv[3])) : servo(participant);
  std::fflush(stdout);
  dds_delete(participant);
  return status;
}
