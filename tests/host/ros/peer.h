// SPDX-License-Identifier: Apache-2.0
// peer.h - what a node of ROS 2 would do; cyclone_peer.cc and fastdds_peer.cc bring the bus.
//
//     PEER DOMAIN read COUNT TOPICS   writes records of four topics, until each of the first TOPICS
//                                     has COUNT
//     PEER DOMAIN servo               writes each line FRAME x y z qw qx qy qz as a pose
//
// Once tact-ros is found, with the first TOPICS topics: "matched", on standard error or output.
//
// A bus has: open_readers(); has_writer(topic); take(topic), which calls write_record and returns
// how many; open_writer(); has_reader(); write(Pose).
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>

namespace tact::tests::ros {

using Values = std::array<double, 7>;
inline constexpr std::array kTopics{"rt/tact/measured_cp", "rt/tact/measured_cv",
                                    "rt/tact/measured_cf", "rt/tact/joint_states"};
inline constexpr const char* kServo = "rt/tact/servo_cp";

#pragma pack(push, 1)
struct Record {
  std::uint8_t topic;
  std::int32_t sec;
  std::uint32_t nanosec;
  Values values;
};
#pragma pack(pop)

inline void write_record(const Record& record) { std::fwrite(&record, sizeof record, 1, stdout); }

/// Three angles, three rates, and how many of the sequences are not as README.md says.
template <typename Names>
Values joint_values(const Names& names, const auto& position, const auto& velocity,
                    std::size_t efforts) {
  const bool right[] = {
      std::ranges::equal(names, std::array{"arm_1", "arm_2", "arm_3"},
                         [](std::string_view a, std::string_view b) { return a == b; }),
      position.size() == 3, velocity.size() == 3, efforts == 0};
  Values out{};
  std::ranges::copy_n(position.begin(), position.size() == 3 ? 3 : 0, out.begin());
  std::ranges::copy_n(velocity.begin(), velocity.size() == 3 ? 3 : 0, out.begin() + 3);
  out[6] = static_cast<double>(std::ranges::count(right, false));
  return out;
}

struct Pose {
  std::string frame;  // "-" of a line is an empty one
  Values values{};    // x y z qw qx qy qz
};

inline Pose pose_of(const std::string& line) {
  std::istringstream words(line);
  Pose pose;
  words >> pose.frame;
  for (double& value : pose.values) {
    std::string word;
    words >> word;
    value = std::strtod(word.c_str(), nullptr);  // of nan and inf, too
  }
  if (pose.frame == "-") pose.frame.clear();
  return pose;
}

void read_topics(auto& bus, int count, std::size_t topics) {
  bus.open_readers();
  for (std::size_t i = 0; i < topics; ++i)
    while (!bus.has_writer(i)) usleep(1000);
  std::fprintf(stderr, "matched\n");
  std::array<int, kTopics.size()> got{};
  while (*std::min_element(got.begin(), got.begin() + static_cast<long>(topics)) < count) {
    usleep(1000);
    for (std::uint8_t i = 0; i < kTopics.size(); ++i) got[i] += bus.take(i);
  }
}

void write_poses(auto& bus) {
  bus.open_writer();
  while (!bus.has_reader()) usleep(1000);
  std::printf("matched\n");
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) bus.write(pose_of(line));
}

template <typename Bus>
int run_peer(int argc, char** argv) {
  if (argc < 3) return 2;
  Bus bus(static_cast<std::uint32_t>(std::atoi(argv[1])));
  if (!bus.good()) return 2;
  if (std::string_view(argv[2]) == "read" && argc == 5)
    read_topics(bus, std::atoi(argv[3]), static_cast<std::size_t>(std::atoi(argv[4])));
  else
    write_poses(bus);
  std::fflush(stdout);
  return 0;
}

}  // namespace tact::tests::ros
