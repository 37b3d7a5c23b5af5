// SPDX-License-Identifier: Apache-2.0
#include "host/server/operator_figure.h"

#include <algorithm>
#include <limits>

#include "host/server/frame_json.h"
#include "tests/support/viewer_fixture.h"

namespace tact::host::server::operator_figure_test {

using test::Socket;
using test::Viewer;

/// One organ triangle, then a tool whose highest vertex is at 100 mm.
record::MeshBytes mesh_with_tool() {
  test::TinyMeshes meshes;
  meshes.tool_m[1][2] = 0.1f;
  return meshes.bytes();
}

record::Frame frame_at(float x_m, std::int64_t time_ns) {
  record::Frame frame;
  frame.time_ns = time_ns;
  frame.tool_position_m[0] = x_m;
  return frame;
}

nlohmann::json reported(OperatorFigure& figure, const record::Frame& frame,
                        const tracking::TrackedOperator* tracked = nullptr) {
  return nlohmann::json::parse(figure.with(frame, tracked));
}

std::string seen(std::uint64_t frames) { return "{\"seen\":" + std::to_string(frames) + "}"; }

TEST(OperatorFigure, TakesTheToolByTheUpperPartOfItsMesh) {
  const record::RunHeader header = test::make_header(3, 1, 3, 1);
  EXPECT_NEAR(grip_of(header, mesh_with_tool()).z(), 0.08, 1e-6);
  EXPECT_NEAR(grip_of(header, {}).z(), figure::FigureSettings{}.grip_m.z(), 1e-12);
}

TEST(OperatorFigure, HoldsTheToolThatTelemetryReports) {
  OperatorFigure figure(1.75);
  figure.begin(test::make_header(3, 1, 3, 1), mesh_with_tool());
  record::Frame frame = frame_at(0.02f, 0);
  frame.tool_orientation[0] = 0.0f;  // half a turn about z: the grip stays above the tip
  frame.tool_orientation[3] = 1.0f;
  const auto json = reported(figure, frame);
  EXPECT_NEAR(json["grip_m"][0].get<double>(), 0.02, 1e-4);
  EXPECT_NEAR(json["grip_m"][2].get<double>(), 0.08, 1e-4);
}

TEST(OperatorFigure, AToolThatIsNotFiniteStaysWhereItWas) {
  OperatorFigure figure(1.75);
  figure.begin(test::make_header(3, 1, 3, 1), mesh_with_tool());
  const auto before = reported(figure, frame_at(0.02f, 0));
  record::Frame none = frame_at(std::numeric_limits<float>::quiet_NaN(), 10'000'000);
  none.tool_orientation[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(reported(figure, none)["grip_m"], before["grip_m"]);
  none = frame_at(0.5f, 20'000'000);
  none.tool_orientation[0] = 0.0f;  // no rotation at all
  EXPECT_EQ(reported(figure, none)["grip_m"], before["grip_m"]);
}

TEST(OperatorFigure, IsWhereTheSceneHasItsShoulder) {
  OperatorFigure figure(1.75);
  const Eigen::Vector3d shoulder_m(0.55, 0.20, 0.45);
  figure.put_shoulder_at(shoulder_m);
  for (int scene = 0; scene < 2; ++scene) {
    figure.begin(test::make_header(3, 1, 3, 1), mesh_with_tool());
    reported(figure, frame_at(0.0f, 0));
    const Eigen::Vector3d got_m = figure.figure()[figure::FigureJoint::kRightShoulder];
    EXPECT_LT((got_m - shoulder_m).norm(), 1e-9) << "scene " << scene;
  }
}

TEST(OperatorFigure, SaysWhetherAViewMayGoWithTheHead) {
  OperatorFigure figure(1.75);
  tracking::TrackedOperator tracked;
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0))["head_tracked"], false);
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0), &tracked)["head_tracked"], false);
  tracked[tracking::BodyRole::kHead] = {.state = tracking::BodyState::kTracked};
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0), &tracked)["head_tracked"], true);
  tracked[tracking::BodyRole::kHead].state = tracking::BodyState::kHeld;
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0), &tracked)["head_tracked"], false);
}

TEST(OperatorFigure, ReportsWhatTheTrackerLost) {
  OperatorFigure figure(1.75);
  tracking::TrackedOperator tracked;
  tracked[tracking::BodyRole::kHead] = {.state = tracking::BodyState::kLost,
                                        .trouble = tracking::TrackingTrouble::kSilent};
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0), &tracked)["words"], "head lost (silent)");
  EXPECT_EQ(reported(figure, frame_at(0.0f, 0))["words"], "");
}

TEST_F(Viewer, SendsTheFigureAfterEachFrameAndItsSkeletonWithTheStatus) {
  OperatorFigure figure(1.75);
  view_.accompany(&figure);
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  const auto status = read(socket);
  EXPECT_EQ(status.at("figure").at("joints").size(), figure::kFigureJoints);
  record::Frame frame;
  for (frame.tick = 1; frame.tick <= 3; ++frame.tick) {
    source_->send(frame);
    const auto first = read(socket), second = read(socket);
    EXPECT_EQ(first["kind"], "frame");
    EXPECT_EQ(second["kind"], "figure");
    EXPECT_EQ(first["tick"], frame.tick);
    EXPECT_EQ(second["tick"], frame.tick);
    socket.write(boost::asio::buffer(seen(frame.tick)));
  }
}

TEST_F(Viewer, SendsTheFigureRightAfterItsFrameEvenIfAStatusCameMeanwhile) {
  OperatorFigure figure(1.75);
  view_.accompany(&figure);
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  read(socket);
  int statuses_that_waited = 0;
  for (std::uint64_t round = 1; round <= 20; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // for the server to be idle
    boost::asio::post(io_, [this] {  // the status waits while the frame is being written
      view_.add(record::Frame{});
      view_.lose("gone");
    });
    std::vector<std::string> kinds;
    for (int i = 0; i < 3; ++i) kinds.push_back(read(socket)["kind"]);
    const auto frame = std::find(kinds.begin(), kinds.end(), "frame");
    ASSERT_LT(frame + 1, kinds.end()) << "round " << round;
    EXPECT_EQ(frame[1], "figure") << "round " << round;
    if (kinds.back() == "status") ++statuses_that_waited;
    socket.write(boost::asio::buffer(seen(round)));
  }
  EXPECT_GT(statuses_that_waited, 0);  // an idle server writes the frame at once
}

TEST_F(Viewer, GivesASlowBrowserTheFigureOfTheFrameThatItGets) {
  OperatorFigure figure(1.75);
  view_.accompany(&figure);
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  read(socket);
  record::Frame frame;
  constexpr std::uint64_t kSent = 100;
  for (frame.tick = 1; frame.tick <= kSent; ++frame.tick) {
    source_->send(frame);  // the browser sleeps; no other client waits
    ASSERT_TRUE(wait_until([&] { return frames_ == frame.tick; }));
  }
  std::uint64_t shown = 0;
  for (std::uint64_t i = 1; i <= LiveSession::kMaxUnseen; ++i) {
    const std::uint64_t tick = read(socket)["tick"];
    EXPECT_GT(tick, shown);
    const auto beside = read(socket);
    EXPECT_EQ(beside["kind"], "figure");
    EXPECT_EQ(beside["tick"], tick);
    shown = tick;
  }
  socket.write(boost::asio::buffer(seen(4)));
  EXPECT_EQ(read(socket)["tick"], kSent);
  EXPECT_EQ(read(socket)["tick"], kSent);
}

TEST_F(Viewer, HasNoFigureUnlessAsked) {
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  EXPECT_FALSE(read(socket).contains("figure"));
}

}  // namespace tact::host::server::operator_figure_test
