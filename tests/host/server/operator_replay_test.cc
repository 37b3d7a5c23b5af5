// SPDX-License-Identifier: Apache-2.0
// The operator of a recording is the one that was seen live, wherever the recording begins; and the
// one who sits at the device stays bound when tactd begins again.
#include "host/server/operator_figure.h"
#include "host/server/playback.h"
#include "tests/support/operator_motion.h"
#include "tests/support/viewer_fixture.h"

namespace tact::host::server::operator_replay_test {

using Eigen::Vector3d;

class Heard final : public LiveListener {
 public:
  void on_status(const Text& status) override {
    skeleton_ = nlohmann::json::parse(*status)["figure"];
  }
  void on_frame(const Text&, const Text& beside) override {
    const auto json = nlohmann::json::parse(*beside);
    figures_[json["tick"]] = json;
  }
  nlohmann::json skeleton_;
  std::map<std::uint64_t, nlohmann::json> figures_;  // by tick
};

record::Frame frame_at(std::uint64_t tick) {
  record::Frame frame = test::make_frame(0.0f, model::ContactState::kFree);
  frame.tick = tick;
  frame.time_ns = std::llround(static_cast<double>(tick) * test::kMotionFrame_s * 1e9);
  const pose::Pose tool = test::tool_at(static_cast<double>(tick) * test::kMotionFrame_s);
  Eigen::Vector3f::Map(frame.tool_position_m) = tool.position_m.cast<float>();
  const Eigen::Quaternionf q = tool.rotation.cast<float>();
  for (int i = 0; i < 4; ++i) frame.tool_orientation[i] = i == 0 ? q.w() : q.vec()[i - 1];
  return frame;
}

void expect_near(const nlohmann::json& got, const nlohmann::json& wanted, double tolerance) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    EXPECT_NEAR(got[i].get<double>(), wanted[i].get<double>(), tolerance);
}

/// One step of the last digit that is reported.
void expect_same(const nlohmann::json& got, const nlohmann::json& wanted) {
  expect_near(got["joint_m"], wanted["joint_m"], 1.01e-4);
  expect_near(got["grip_m"], wanted["grip_m"], 1.01e-4);
  expect_near(got["head"], wanted["head"], 1.01e-5);
  EXPECT_NEAR(got["error_mm"].get<double>(), wanted["error_mm"].get<double>(), 1.01e-3);
  for (const char* key : {"tick", "reached", "sweeps", "updates", "full_chain", "trouble", "words"})
    EXPECT_EQ(got[key], wanted[key]) << key;
}

class OperatorReplay : public test::Viewer {
 protected:
  /// Plays a recording as --open does, until every frame of it was heard.
  static Heard replay(record::Recording recording) {
    boost::asio::io_context io;
    LiveView view;
    OperatorFigure figure(recording.body_height_m().value_or(1.75));
    view.accompany(&figure);
    Heard heard;
    view.subscribe(heard);
    const std::size_t frames = recording.frames.size();
    Playback playback(io, view, std::move(recording), "made-up");
    playback.start();
    while (heard.figures_.size() < frames && io.run_one_for(std::chrono::seconds(5)) > 0) continue;
    return heard;
  }
};

TEST_F(OperatorReplay, ReplayFromTheMiddleShowsTheFigureOfTheLiveRun) {
  OperatorFigure live(1.9);
  live.put_shoulder_at({0.55, 0.15, 0.45});  // of the scene; the recording does not know it
  view_.accompany(&live);
  start();
  start_source();
  Heard seen;
  std::atomic<bool> done = false;
  constexpr std::uint64_t kFrom = 240, kTo = 300;
  boost::asio::post(io_, [&] {
    view_.subscribe(seen);
    for (std::uint64_t tick = 0; tick <= kTo; ++tick) {
      tracking::TrackedOperator bodies =  // of whom the head falls silent at 4.5 s
          test::troubled_bodies_at(static_cast<double>(tick) * test::kMotionFrame_s + 0.5);
      bodies[tracking::BodyRole::kShoulder] = {};
      view_.add(frame_at(tick), &bodies);
    }
    view_.unsubscribe(seen);
    done = true;
  });
  while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string file = folder_ / "a.tact";
  std::ofstream(file, std::ios::binary)
      << get("/recording.tactview?from_tick=240&to_tick=300").body();
  record::ReadResult read = record::read_recording(file);
  ASSERT_EQ(read.damage, "");
  ASSERT_EQ(read.recording.frames.size(), kTo - kFrom + 1);
  const Heard again = replay(std::move(read.recording));
  EXPECT_EQ(again.skeleton_, seen.skeleton_) << "a body of the same height";
  ASSERT_EQ(again.figures_.size(), kTo - kFrom + 1);
  for (const auto& [tick, figure] : again.figures_) expect_same(figure, seen.figures_[tick]);
  EXPECT_EQ(again.figures_.at(kFrom)["words"], "");
  EXPECT_EQ(again.figures_.at(kTo)["words"], "head lost (silent)");
}

TEST_F(OperatorReplay, StaysBoundWhenTheDeviceBeginsAgain) {
  OperatorFigure live(1.75);
  const auto head_m = [&](const Vector3d& at_m, std::uint64_t tick) {
    tracking::TrackedOperator bodies;
    bodies[tracking::BodyRole::kHead].state = tracking::BodyState::kTracked;
    bodies[tracking::BodyRole::kHead].pose.position_m = at_m;
    const auto json = nlohmann::json::parse(live.with(frame_at(tick), &bodies));
    const std::size_t i = 3 * static_cast<std::size_t>(figure::FigureJoint::kHead);
    return Vector3d(json["joint_m"][i], json["joint_m"][i + 1], json["joint_m"][i + 2]);
  };
  const Vector3d upright(0.4, -0.08, 0.56), leans = upright + Vector3d(-0.10, 0.05, -0.03);
  std::uint64_t tick = 0;
  live.begin(header_, meshes_);
  Vector3d neutral_m, leaning_m, again_m;
  for (; tick < 120; ++tick) neutral_m = head_m(upright, tick);
  for (; tick < 240; ++tick) leaning_m = head_m(leans, tick);
  EXPECT_GT((leaning_m - neutral_m).norm(), 0.05);
  live.begin(header_, meshes_);  // its clock is at 0 again, and the operator still leans
  for (tick = 0; tick < 120; ++tick) again_m = head_m(leans, tick);
  EXPECT_LT((again_m - leaning_m).norm(), 3e-3);
}

}  // namespace tact::host::server::operator_replay_test
