// SPDX-License-Identifier: Apache-2.0
// The tracked operator in a recording: it comes back, damage costs one frame's operator, and files
// without one stay as they are.
#include "host/record/operator_record.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "host/record/recording_csv.h"
#include "host/server/live_view.h"
#include "tests/host/record/spoilt_file.h"
#include "tests/support/message.h"
#include "tests/support/telemetry_source.h"
#include "tests/support/tracking_views.h"

namespace tact::host::record::operator_record_test {

using tests::message_of;

constexpr std::size_t kFrames = 20;
const firmware::protocol::FieldTable kFields = Frame::fields(2);  // the spheres of make_header
const std::size_t kFrameBytes = chunk_of(Frame{}, kFields).size();
const std::size_t kStride = kFrameBytes + firmware::protocol::chunk_of(OperatorRecord{}).size();

tracking::TrackedOperator operator_at(std::size_t i) {
  tracking::TrackedOperator out{.time_s = 0.1 * static_cast<double>(i)};
  tracking::TrackedBody& hand = out[tracking::BodyRole::kHand];
  hand.state = tracking::BodyState::kTracked;
  hand.trouble = tracking::TrackingTrouble::kJump;
  hand.raw = {.rotation = test::turn(0.3 + 0.1 * static_cast<double>(i), {1, 2, 3}),
              .position_m = {0.1, 1.0 / 3.0, static_cast<double>(i)}};
  hand.pose = {.rotation = test::turn(0.2, {3, 2, 1}), .position_m = {0.5, 0.25, -1.0}};
  hand.rms_px = 0.5;
  hand.age_s = 0.015625;
  return out;
}

/// Not a figure that could be: every number is its own.
figure::FigurePose figure_at(std::size_t i) {
  figure::FigurePose out;
  out.height_m = 1.9;
  for (std::size_t k = 0; k < figure::kFigureJoints; ++k)
    out.joint_m[k] = {0.25 * static_cast<double>(k), -1.0, static_cast<double>(i)};
  out.head = test::turn(0.4, {1, 0, 2});
  out.grip_m = {0.5, 0.0, 2.0 * static_cast<double>(i)};
  out.arm = {.reached = false,
             .out_of_reach = true,
             .full_chain = true,
             .error_m = 0.125,
             .sweeps = 33,
             .updates = 44};
  out.leg_reached = {true, false};
  out.shoulder_too_far = true;
  out.left_hand_reached = false;
  return out;
}

OperatorRecord unpacked(const std::string& chunk) {
  using firmware::protocol::Unpacker;
  const auto fields = OperatorRecord::fields();
  OperatorRecord out;
  EXPECT_TRUE(Unpacker::make(firmware::protocol::json_of(fields), fields)
                  ->unpack(firmware::protocol::chunk_in(chunk)->content, &out));
  return out;
}

class TrackedFile : public ::testing::Test {
 protected:
  TrackedFile()
      : path_("/tmp/tact-tracked-" + std::to_string(getpid()) + ".tact"),
        first_(start_of_recording(header_, mesh_).size()) {
    std::filesystem::remove(path_);
    RecordingWriter writer;
    EXPECT_EQ(message_of(writer.open(path_, header_, mesh_)), "");
    for (std::size_t i = 0; i < kFrames; ++i) {
      const tracking::TrackedOperator tracked = operator_at(i);
      const figure::FigurePose shown = figure_at(i);
      EXPECT_EQ(message_of(
                    writer.write(frame(i), i == 3 ? nullptr : &tracked, i == 3 ? nullptr : &shown)),
                "");
    }
    EXPECT_EQ(message_of(writer.close()), "");
  }
  ~TrackedFile() override { std::filesystem::remove(path_); }

  static Frame frame(std::size_t i) {
    Frame out = test::make_frame(static_cast<float>(i), model::ContactState::kInContact);
    out.tick = i;
    out.time_ns = static_cast<std::int64_t>(i) * 10'000'000;
    return out;
  }

  /// Where frame i begins; the fourth has no operator.
  std::uint64_t byte_of(std::size_t i) const {
    return first_ + i * kStride - (i > 3 ? kStride - kFrameBytes : 0);
  }

  std::string path_;
  RunHeader header_ = test::make_header(3, 1, 3, 1);
  MeshBytes mesh_ = test::TinyMeshes{}.bytes();
  std::uint64_t first_;
};

TEST_F(TrackedFile, GivesTheOperatorBack) {
  const ReadResult read = read_recording(path_);
  ASSERT_EQ(read.damage, "");
  ASSERT_EQ(read.recording.frames.size(), kFrames);
  ASSERT_EQ(read.recording.operators.size(), kFrames);
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}}) {
    const tracking::TrackedOperator& got = read.recording.operators[i];
    const tracking::TrackedBody& hand = got[tracking::BodyRole::kHand];
    const tracking::TrackedBody truth = operator_at(i)[tracking::BodyRole::kHand];
    EXPECT_EQ(got.time_s, operator_at(i).time_s);
    EXPECT_EQ(hand.state, truth.state);
    EXPECT_EQ(hand.trouble, truth.trouble);
    EXPECT_EQ(hand.raw.position_m, truth.raw.position_m);  // bit by bit
    EXPECT_EQ(hand.raw.rotation.coeffs(), truth.raw.rotation.coeffs());
    EXPECT_EQ(hand.pose.position_m, truth.pose.position_m);
    EXPECT_LT(hand.pose.rotation.angularDistance(truth.pose.rotation), 1e-6);
    EXPECT_EQ(hand.rms_px, 0.5);
    EXPECT_EQ(hand.age_s, 0.015625);
    EXPECT_EQ(got[tracking::BodyRole::kHead].state, tracking::BodyState::kAbsent);
  }
  EXPECT_EQ(read.recording.operators[3][tracking::BodyRole::kHand].state,
            tracking::BodyState::kAbsent);
}

TEST_F(TrackedFile, GivesTheFigureBackAsItWasShown) {
  const Recording recording = read_recording(path_).recording;
  ASSERT_EQ(recording.figures.size(), kFrames);
  EXPECT_EQ(recording.body_height_m(), 1.9);
  const figure::FigurePose truth = figure_at(7),
                           got = recording.figures[7].value_or(figure::FigurePose{});
  for (std::size_t k = 0; k < figure::kFigureJoints; ++k)
    EXPECT_EQ(got.joint_m[k], truth.joint_m[k]);
  EXPECT_LT(got.head.angularDistance(truth.head), 1e-6);
  EXPECT_EQ(got.grip_m, truth.grip_m);
  EXPECT_EQ(got.arm.reached, truth.arm.reached);
  EXPECT_EQ(got.arm.out_of_reach, truth.arm.out_of_reach);
  EXPECT_EQ(got.arm.full_chain, truth.arm.full_chain);
  EXPECT_EQ(got.arm.error_m, truth.arm.error_m);
  EXPECT_EQ(got.arm.sweeps, truth.arm.sweeps);
  EXPECT_EQ(got.arm.updates, truth.arm.updates);
  EXPECT_EQ(got.leg_reached, truth.leg_reached);
  EXPECT_EQ(got.shoulder_too_far, truth.shoulder_too_far);
  EXPECT_EQ(got.left_hand_reached, truth.left_hand_reached);
  EXPECT_EQ(got.words, "the arm cannot reach the tool");
  EXPECT_EQ(recording.figure_at(3), nullptr) << "none was shown there";
}

TEST_F(TrackedFile, DamageOfOneOperatorCostsNoFrame) {
  tests::flip_byte(path_, byte_of(5) + kFrameBytes + 100);
  const ReadResult read = read_recording(path_);
  ASSERT_EQ(read.recording.frames.size(), kFrames);
  EXPECT_EQ(read.recording.operators[5][tracking::BodyRole::kHand].state,
            tracking::BodyState::kAbsent);
  EXPECT_EQ(read.recording.operators[6][tracking::BodyRole::kHand].state,
            tracking::BodyState::kTracked);
  ASSERT_NE(read.recording.figure_at(5), nullptr);
  EXPECT_EQ(read.recording.figure_at(5)->grip_m, figure_at(4).grip_m) << "the figure holds";
  EXPECT_NE(read.damage.find("1 of 19 operators are damaged"), std::string::npos) << read.damage;
}

TEST_F(TrackedFile, DamageOfAFrameTakesItsOperatorAlong) {
  tests::flip_byte(path_, byte_of(5) + 100);
  const ReadResult read = read_recording(path_);
  ASSERT_EQ(read.recording.frames.size(), kFrames - 1);
  ASSERT_EQ(read.recording.operators.size(), kFrames - 1);
  EXPECT_EQ(read.recording.frames[5].tick, 6u);
  EXPECT_EQ(read.recording.operators[5].time_s, operator_at(6).time_s);
}

TEST_F(TrackedFile, SurvivesEveryLength) {
  for (std::uint64_t size = first_ + 3 * kStride + 5; size > 0; size = size * 19 / 20) {
    std::filesystem::resize_file(path_, size);
    const ReadResult read = read_recording(path_);
    EXPECT_FALSE(read.damage.empty()) << size;
    if (!read.recording.operators.empty())
      EXPECT_EQ(read.recording.frames.size(), read.recording.operators.size());
    const std::uint64_t left = size < first_ ? 0 : size - first_;  // a last frame needs no operator
    EXPECT_EQ(read.recording.frames.size(),
              left / kStride + (left % kStride >= kFrameBytes ? 1 : 0));
  }
}

TEST_F(TrackedFile, WithoutATrackerTheFileHasNoOperators) {
  std::filesystem::remove(path_);
  RecordingWriter writer;
  ASSERT_EQ(message_of(writer.open(path_, header_, mesh_)), "");
  ASSERT_EQ(message_of(writer.write(frame(0))), "");
  ASSERT_EQ(message_of(writer.close()), "");
  std::ifstream file(path_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string content = start_of_recording(header_, mesh_) + chunk_of(frame(0), kFields);
  model::io::Seal seal;
  seal.add(content);
  EXPECT_EQ(bytes, content + seal.bytes());
  const ReadResult read = read_recording(path_);
  EXPECT_EQ(read.damage, "");
  EXPECT_TRUE(read.recording.operators.empty());
  EXPECT_EQ(read.recording.operator_at(0), nullptr);
}

TEST(OperatorRecord, InvalidBodyIsRefusedDespiteAGoodChecksum) {
  const auto accepts = [](auto change) {
    tracking::TrackedOperator tracked = operator_at(1);
    change(tracked[tracking::BodyRole::kHand]);
    const OperatorRecord record = unpacked(operator_chunk(tracked));
    return operator_of(record).has_value();
  };
  EXPECT_TRUE(accepts([](tracking::TrackedBody&) {}));
  EXPECT_FALSE(accepts([](tracking::TrackedBody& b) { b.raw.position_m.x() = std::nan(""); }));
  EXPECT_FALSE(accepts([](tracking::TrackedBody& b) { b.pose.rotation.w() = 5.0; }));
  EXPECT_FALSE(accepts([](tracking::TrackedBody& b) { b.rms_px = HUGE_VAL; }));
  EXPECT_FALSE(
      accepts([](tracking::TrackedBody& b) { b.state = static_cast<tracking::BodyState>(4); }));
  EXPECT_FALSE(accepts(
      [](tracking::TrackedBody& b) { b.trouble = static_cast<tracking::TrackingTrouble>(9); }));
}

TEST(OperatorRecord, InvalidFigureIsDroppedDespiteAGoodChecksum) {
  const auto accepts = [](auto change) {
    figure::FigurePose shown = figure_at(1);
    change(shown);
    const tracking::TrackedOperator tracked = operator_at(1);
    const OperatorRecord record = unpacked(operator_chunk(tracked, &shown));
    EXPECT_TRUE(operator_of(record).has_value());
    return figure_of(record, tracked).has_value();
  };
  EXPECT_TRUE(accepts([](figure::FigurePose&) {}));
  EXPECT_FALSE(accepts([](figure::FigurePose& f) { f.joint_m[22].z() = std::nan(""); }));
  EXPECT_FALSE(accepts([](figure::FigurePose& f) { f.head.w() = 5.0; }));
  EXPECT_FALSE(accepts([](figure::FigurePose& f) { f.grip_m.x() = HUGE_VAL; }));
  EXPECT_FALSE(accepts([](figure::FigurePose& f) { f.arm.error_m = std::nan(""); }));
  EXPECT_FALSE(accepts([](figure::FigurePose& f) { f.height_m = 0.0; }));
}

TEST_F(TrackedFile, TheTableHasTheRawPoseOfTheBodiesThatAreThere) {
  const ReadResult read = read_recording(path_);
  const std::vector<tracking::BodyRole> bodies = bodies_in(read.recording);
  ASSERT_EQ(bodies, std::vector{tracking::BodyRole::kHand});
  const std::string header = csv_header(header_, bodies);
  EXPECT_NE(header.find(",hand_state,hand_x_m,hand_y_m,hand_z_m,hand_qw,"), std::string::npos);
  EXPECT_EQ(header.find("head_"), std::string::npos);
  for (const std::size_t i : {std::size_t{2}, std::size_t{3}}) {
    std::string row;
    append_csv_row(row, read.recording.frames[i], header_, read.recording.operator_at(i), bodies);
    EXPECT_EQ(std::count(row.begin(), row.end(), ','),
              std::count(header.begin(), header.end(), ','));
    EXPECT_EQ(row.find(",tracked,0.1,0.3333333333333333,2,") != std::string::npos, i == 2) << row;
    EXPECT_EQ(row.find(",absent,") != std::string::npos, i == 3) << row;
  }
}

TEST(RecentFrames, KeepTheOperatorInStep) {
  RecentFrames recent;
  recent.restart(1.0);  // 300 frames
  Frame frame;
  for (frame.tick = 0; frame.tick < 500; ++frame.tick) {
    const tracking::TrackedOperator tracked{.time_s = static_cast<double>(frame.tick)};
    const figure::FigurePose shown = figure_at(frame.tick);
    recent.add(frame, frame.tick < 10 ? nullptr : &tracked, &shown);
    EXPECT_EQ(recent.frames().back()->person != nullptr, frame.tick >= 10);
  }
  ASSERT_EQ(recent.frames().size(), 300u);
  for (const auto& kept : recent.frames()) {
    EXPECT_EQ(kept->person->tracked.time_s, static_cast<double>(kept->frame.tick));
    ASSERT_TRUE(kept->person->figure.has_value());
    EXPECT_EQ(kept->person->figure->grip_m, figure_at(kept->frame.tick).grip_m);
  }
}

}  // namespace tact::host::record::operator_record_test
