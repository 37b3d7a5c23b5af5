// SPDX-License-Identifier: Apache-2.0
// A recording is shown from where, as fast and as often as a page asks, and a page can ask nothing
// else.
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/server/playback.h"
#include "tests/support/telemetry_source.h"

namespace tact::host::server::replay_test {

using firmware::loop::State;

constexpr std::int64_t kFrame_ns = 10'000'000;

TEST(ReplayRequest, IsReadFromAPagesMessage) {
  const auto request = parse_replay(
      R"({"replay":{"playing":true,"at_s":1.5,"step_frames":-1,"speed_ratio":0.25,"repeats":false}})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->playing, true);
  EXPECT_EQ(request->at_s, 1.5);
  EXPECT_EQ(request->step_frames, -1);
  EXPECT_EQ(request->speed_ratio, 0.25);
  EXPECT_EQ(request->repeats, false);
  EXPECT_FALSE(parse_replay(R"({"replay":{"at_s":2}})")->playing);
}

TEST(ReplayRequest, IsRefusedWhenAnyOfItIsNotSensible) {
  for (const char* text :
       {"", "{", "[]", "null", "7", R"({"replay":7})", R"({"replay":{"arm":true}})",
        R"({"replay":{"at_s":-1}})", R"({"replay":{"at_s":1e99}})", R"({"replay":{"at_s":"0"}})",
        R"({"replay":{"speed_ratio":0}})", R"({"replay":{"speed_ratio":NaN}})",
        R"({"replay":{"playing":1}})", R"({"replay":{"step_frames":1.5}})",
        R"({"replay":{"step_frames":1e18}})", R"({"replay":{"at_s":1,"stop":true}})",
        R"({"hand":{"x_m":0,"y_m":0,"z_m":0,"grip_ratio":0}})"})
    EXPECT_FALSE(parse_replay(text)) << text;
}

class Heard final : public LiveListener {
 public:
  void on_status(const Text& status) override { status_ = nlohmann::json::parse(*status); }
  void on_frame(const Text& frame, const Text&) override {
    ticks_.push_back(nlohmann::json::parse(*frame)["tick"]);
  }
  const nlohmann::json& replay() const { return status_["replay"]; }
  nlohmann::json status_;
  std::vector<std::uint64_t> ticks_;
};

class Replay : public ::testing::Test {
 protected:
  /// 100 frames in 0.99 s; stopped by a fault from frame 80 on.
  static record::Recording recording() {
    record::Recording out;
    out.header = test::make_header(3, 1, 3, 1);
    out.mesh = test::TinyMeshes{}.bytes();
    for (int i = 0; i < 100; ++i) {
      record::Frame frame = test::make_frame(0.0f, model::ContactState::kFree);
      frame.tick = static_cast<std::uint64_t>(i);
      frame.time_ns = 7'000'000'000 + i * kFrame_ns;
      frame.state = i < 80 ? State::kArmed : State::kStopped;
      frame.fault = i < 80 ? 0 : 131;
      out.frames.push_back(frame);
    }
    return out;
  }
  /// Runs what is due within this time.
  void run_for(int ms) { io_.restart(), io_.run_for(std::chrono::milliseconds(ms)); }
  void run_to_its_end() {
    io_.restart();
    while (heard_.replay()["playing"] && io_.run_one_for(std::chrono::seconds(5)) > 0) continue;
  }
  void rest() {
    playback_.steer(
        {.playing = false, .at_s = {}, .step_frames = {}, .speed_ratio = {}, .repeats = {}});
  }
  void seek(double at_s) {
    playback_.steer(
        {.playing = {}, .at_s = at_s, .step_frames = {}, .speed_ratio = {}, .repeats = {}});
  }
  void step(int frames) {
    playback_.steer(
        {.playing = {}, .at_s = {}, .step_frames = frames, .speed_ratio = {}, .repeats = {}});
  }
  void play(double speed_ratio) {
    playback_.steer({.playing = true,
                     .at_s = {},
                     .step_frames = {},
                     .speed_ratio = speed_ratio,
                     .repeats = {}});
  }

  boost::asio::io_context io_;
  LiveView view_;
  Heard heard_;
  Playback playback_{io_, view_, recording(), "made-up"};
};

TEST_F(Replay, BeginsWithItsFirstViewerAndRestsAtItsEnd) {
  playback_.start();
  run_for(100);
  view_.subscribe(heard_);
  EXPECT_EQ(heard_.ticks_, std::vector<std::uint64_t>{0}) << "not one of the 100 ms is lost";
  play(20.0);
  run_to_its_end();
  EXPECT_EQ(heard_.ticks_.size(), 100U);
  EXPECT_EQ(heard_.ticks_.back(), 99U);
  run_for(50);
  EXPECT_EQ(heard_.ticks_.size(), 100U) << "it rests";
  play(20.0);
  EXPECT_EQ(heard_.ticks_.back(), 0U) << "played again it begins again";
}

TEST_F(Replay, ReportsItsLengthAndWhereItStopped) {
  playback_.start();
  view_.subscribe(heard_);
  EXPECT_EQ(heard_.status_["link"], "replay");
  EXPECT_EQ(heard_.replay()["start_s"], 7.0);
  EXPECT_DOUBLE_EQ(heard_.replay()["length_s"], 0.99);
  EXPECT_EQ(heard_.replay()["frames"], 100);
  ASSERT_EQ(heard_.replay()["stops"].size(), 1U);
  EXPECT_DOUBLE_EQ(heard_.replay()["stops"][0]["at_s"], 0.8);
  EXPECT_EQ(heard_.replay()["stops"][0]["fault"], 131);
}

TEST_F(Replay, SeeksToTheRequestedTimeAndRestsThere) {
  playback_.start();
  view_.subscribe(heard_);
  rest();
  seek(0.5);
  EXPECT_EQ(heard_.ticks_.back(), 50U);
  step(-1);
  EXPECT_EQ(heard_.ticks_.back(), 49U);
  step(1);
  EXPECT_EQ(heard_.ticks_.back(), 50U);
  step(-1000);
  EXPECT_EQ(heard_.ticks_.back(), 0U);
  seek(1000.0);
  EXPECT_EQ(heard_.ticks_.back(), 99U);
  const std::size_t seen = heard_.ticks_.size();
  run_for(50);
  EXPECT_EQ(heard_.ticks_.size(), seen) << "it rests";
  Heard late;
  view_.subscribe(late);
  EXPECT_EQ(late.ticks_, std::vector<std::uint64_t>{99}) << "who comes now sees where it rests";
  view_.unsubscribe(late);
}

TEST_F(Replay, ItsTableIsTheWholeFileAfterAnySeek) {
  playback_.start();
  view_.subscribe(heard_);
  rest();
  for (const double at_s : {0.0, 0.2, 0.1}) {
    seek(at_s);
    const auto all = view_.recent(0, UINT64_MAX).frames;
    ASSERT_EQ(all.size(), 100U);
    EXPECT_EQ(all[99]->frame.tick, 99U);
  }
  EXPECT_EQ(view_.recent(20, 29).frames.size(), 10U);
  view_.begin(recording().header, test::TinyMeshes{}.bytes(), Link::kLive);
  EXPECT_TRUE(view_.recent(0, UINT64_MAX).frames.empty()) << "not of the run after it";
}

TEST_F(Replay, PlaysInOneRowForAnyRequests) {
  playback_.start();
  view_.subscribe(heard_);
  for (int i = 0; i < 50; ++i) play(20.0), io_.poll();
  run_to_its_end();
  EXPECT_EQ(heard_.ticks_.back(), 99U);
  for (std::size_t i = 1; i < heard_.ticks_.size(); ++i)
    ASSERT_EQ(heard_.ticks_[i], (heard_.ticks_[i - 1] + 1) % 100) << "none twice, none left out";
}

}  // namespace tact::host::server::replay_test
