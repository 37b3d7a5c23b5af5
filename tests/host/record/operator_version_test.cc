// SPDX-License-Identifier: Apache-2.0
// A recording of version 8, whose operator has ten bodies: it is read, and damage of it is told.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/record/operator_record.h"
#include "host/record/recording.h"
#include "model/io/seal.h"
#include "tests/host/record/spoilt_file.h"
#include "tests/support/telemetry_source.h"

namespace tact::host::record::operator_version_test {

using tracking::BodyRole;
using tracking::BodyState;

constexpr std::size_t kFrames = 8;
constexpr std::size_t kOldBytes = 1304;
const Eigen::Vector3d kWaist_m(0.1, 1.0 / 3.0, 0.5), kGrip_m(0.5, 0.0, 2.0);

/// One operator as version 9 writes him, less the two bodies that version 8 did not know.
std::string old_operator() {
  tracking::TrackedOperator tracked{.time_s = 1.5};
  for (const BodyRole role : {BodyRole::kWaist, BodyRole::kLeftHand, BodyRole::kElbow})
    tracked[role] = {.state = BodyState::kTracked, .raw = {.position_m = kWaist_m}};
  figure::FigurePose shown;
  shown.height_m = 1.9;
  shown.joint_m.fill(Eigen::Vector3d::Ones());
  shown.grip_m = kGrip_m;
  shown.arm.reached = true;
  std::string out = operator_record(tracked, &shown);
  out.erase(offsetof(OperatorRecord, body) + 10 * sizeof(BodyRecord), 2 * sizeof(BodyRecord));
  const std::uint32_t crc = firmware::telemetry::crc_of(out.data(), out.size() - 8);
  std::memcpy(out.data() + out.size() - 8, &crc, sizeof crc);
  return out;
}

class OldRecording : public testing::Test {
 protected:
  OldRecording() : path_("/tmp/tact-version-8-" + std::to_string(getpid()) + ".tact") {
    const Hello hello = test::make_hello(3, 1, 3, 1);
    std::string bytes = recording_start(hello, test::TinyMeshes{}.bytes(), 8);
    first_ = bytes.size();
    for (std::size_t i = 0; i < kFrames; ++i) {
      const auto touching = firmware::telemetry::SiteState::kTouching;
      Frame frame = test::make_frame(static_cast<float>(i), touching);
      frame.tick = i;
      bytes += recording_frame(frame) + old_operator();
    }
    model::io::Seal seal;
    seal.add(bytes);
    std::ofstream(path_, std::ios::binary) << bytes << seal.bytes();
  }
  ~OldRecording() override { std::filesystem::remove(path_); }

  std::string path_;
  std::size_t first_ = 0;
};

TEST_F(OldRecording, OfVersion8IsReadAndHasNoLeftHandAndNoElbow) {
  ASSERT_EQ(old_operator().size(), kOldBytes);
  const ReadResult read = read_recording(path_);
  EXPECT_EQ(read.damage, "");
  ASSERT_EQ(read.recording.operators.size(), kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const tracking::TrackedOperator& got = read.recording.operators[i];
    EXPECT_EQ(got.time_s, 1.5);
    EXPECT_EQ(got[BodyRole::kWaist].state, BodyState::kTracked);
    EXPECT_EQ(got[BodyRole::kWaist].raw.position_m, kWaist_m);
    EXPECT_EQ(got[BodyRole::kLeftHand].state, BodyState::kAbsent);
    EXPECT_EQ(got[BodyRole::kElbow].state, BodyState::kAbsent);
    ASSERT_NE(read.recording.figure_at(i), nullptr);
    EXPECT_EQ(read.recording.figure_at(i)->grip_m, kGrip_m);
    EXPECT_EQ(read.recording.figure_at(i)->words, "") << "nothing of a left hand";
  }
}

TEST_F(OldRecording, DamageOfOneOperatorCostsNoFrame) {
  const std::size_t stride = sizeof(FrameRecord) + kOldBytes;
  tests::flip_byte(path_, first_ + 5 * stride + sizeof(FrameRecord) + 40);
  const ReadResult read = read_recording(path_);
  EXPECT_EQ(read.recording.frames.size(), kFrames);
  EXPECT_EQ(read.recording.operators[5][BodyRole::kWaist].state, BodyState::kAbsent);
  EXPECT_EQ(read.recording.operators[6][BodyRole::kWaist].state, BodyState::kTracked);
  EXPECT_NE(read.damage.find("1 of 8 frames have lost their operator"), std::string::npos)
      << read.damage;
}

}  // namespace tact::host::record::operator_version_test
