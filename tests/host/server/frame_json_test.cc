// SPDX-License-Identifier: Apache-2.0
#include "host/server/frame_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/message.h"
#include "tests/support/telemetry_source.h"

namespace tact::host::server::frame_json_test {

using tests::message_of;

record::RunHeader busiest_header() {
  record::RunHeader header = test::make_header(3, 1, 3, 1);
  header.spheres.resize(firmware::protocol::kMaxContacts);
  header.profile_points = firmware::protocol::kMaxProfilePoints;
  return header;
}

// Every site held, every number as long as it can be.
record::Frame longest_frame() {
  const float longest = -std::numeric_limits<float>::min();  // -1.175e-38
  record::Frame frame = test::make_frame(longest, model::ContactState::kHeld);
  frame.tick = frame.late_ticks = frame.skipped_ticks = frame.dropped_records = UINT64_MAX;
  frame.time_ns = INT64_MIN;
  frame.fault = frame.limit = UINT16_MAX;
  frame.contact_losses = UINT32_MAX;
  return frame;
}

TEST(FrameJson, StaysInItsLengthForAnyNumbers) {
  const std::string text = frame_json(longest_frame(), busiest_header());
  EXPECT_LE(text.size(), kMaxFrameJsonBytes);
  EXPECT_GT(text.size(), kMaxFrameJsonBytes - 200) << "the bound is no larger than it must be";
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(FrameJson, SaysNullForNumbersThatAreNotFinite) {
  const record::Frame frame =
      test::make_frame(std::numeric_limits<float>::quiet_NaN(), model::ContactState::kInContact);
  const auto json = nlohmann::json::parse(frame_json(frame, busiest_header()), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  EXPECT_TRUE(json["force_N"][2].is_null());
  EXPECT_TRUE(json["contacts"][3]["profile_m"][31].is_null());
  EXPECT_TRUE(json["worst_margin_us"].is_null());
}

TEST(FrameJson, ListsOnlySitesInContactWithTheRingsInUse) {
  record::Frame frame = test::make_frame(0.002f, model::ContactState::kFree);
  frame.contact[1].state = model::ContactState::kHeld;
  const record::RunHeader header = test::make_header(3, 1, 3, 1);  // 2 contacts, 11 rings
  const auto json = nlohmann::json::parse(frame_json(frame, header), nullptr, false);
  ASSERT_EQ(json["contacts"].size(), 1u);
  EXPECT_EQ(json["contacts"][0]["contact"], 1);
  EXPECT_EQ(json["contacts"][0]["state"], 2);
  EXPECT_EQ(json["contacts"][0]["profile_m"].size(), 11u);
}

TEST(FrameJson, ListsASphereInsideAndCountsLossesOfContact) {
  record::Frame frame = test::make_frame(0.0f, model::ContactState::kFree);
  frame.contact[0].state = model::ContactState::kInside;
  frame.contact_losses = 4;
  const auto json =
      nlohmann::json::parse(frame_json(frame, test::make_header(3, 1, 3, 1)), nullptr, false);
  ASSERT_EQ(json["contacts"].size(), 1u);
  EXPECT_EQ(json["contacts"][0]["state"], 3);
  EXPECT_EQ(json["contact_losses"], 4);
}

TEST(FrameJson, KeepsSixDigits) {
  record::Frame frame;
  frame.force_N[2] = 1.23456f;
  frame.tool_position_m[0] = 0.123456f;
  frame.time_ns = 1'500'000'000;
  const auto json = nlohmann::json::parse(frame_json(frame, busiest_header()), nullptr, false);
  EXPECT_NEAR(json["force_N"][2].get<double>(), 1.23456, 5e-6);
  EXPECT_NEAR(json["tool_position_m"][0].get<double>(), 0.123456, 5e-7);
  EXPECT_EQ(json["time_ns"], 1'500'000'000);
  EXPECT_TRUE(json["contacts"].empty());
}

TEST(FrameJson, DoesNotTrustCountsBeyondTheArrays) {
  record::RunHeader header = busiest_header();
  header.spheres.resize(firmware::protocol::kMaxContacts + 5);
  header.profile_points = UINT32_MAX;
  const record::Frame frame = test::make_frame(1.0f, model::ContactState::kHeld);
  const auto json = nlohmann::json::parse(frame_json(frame, header), nullptr, false);
  EXPECT_EQ(json["contacts"].size(), firmware::protocol::kMaxContacts);
}

TEST(SceneJson, SaysWhatTheHeadSays) {
  record::RunHeader header = test::make_header(5, 6, 7, 8);
  header.limits_checksum = "1a2b3c4d";
  header.hand_socket = "/run/user/0/tact/hand";
  const auto json = nlohmann::json::parse(scene_json(header), nullptr, false);
  EXPECT_EQ(json["limits_checksum"], "1a2b3c4d");
  EXPECT_EQ(json["scene_name"], "liver (synthetic)");
  EXPECT_EQ(json["organ_triangles"], 6);
  EXPECT_EQ(json["spheres"].size(), 2u);
  EXPECT_EQ(json["simulated"], true);
  EXPECT_EQ(json["cannot_grip"], false);
  for (const char* of_the_pc : {"hand_socket", "host_name", "overrides"})
    EXPECT_FALSE(json.contains(of_the_pc)) << of_the_pc;
}

TEST(CheckHeader, RefusesCountsAndNumbersWithoutSense) {
  const auto refuses = [](auto spoil) {
    record::RunHeader header = test::make_header(5, 6, 7, 8);
    spoil(header);
    return record::check_header(header).has_value();
  };
  EXPECT_FALSE(refuses([](record::RunHeader&) {}));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.piece_color_ratio.resize(5); }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.piece_color_ratio = {{0, 0, -1.0f}}; }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.spheres.resize(17); }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.tasks.resize(17); }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.tasks.emplace_back().hold_s = std::nan(""); }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.profile_points = 33; }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.tool_vertices = 4'000'001; }));
  EXPECT_TRUE(refuses([](record::RunHeader& h) { h.rate_Hz = -1.0; }));
}

TEST(SceneJson, SurvivesANameWithBrokenUtf8) {
  record::RunHeader header = test::make_header(3, 1, 3, 1);
  header.scene_name = std::string(50, '\xFF');
  EXPECT_TRUE(nlohmann::json::accept(scene_json(header)));
}

TEST(FrameJson, ReportsDisplacedVerticesAndCutsOfALawWithoutProfiles) {
  record::Frame frame{};
  frame.patch.vertex_count = 2;
  frame.patch.vertex[0] = 7;
  frame.patch.vertex[1] = 70'000;
  const std::int16_t moved_um[2][3] = {{1, -2, 3}, {32767, 0, -1}};
  std::memcpy(frame.patch.displacement_um, moved_um, sizeof moved_um);
  frame.patch.cut_total = 40;
  frame.patch.cut_count = 2;
  frame.patch.cut_triangle[0] = 11;
  frame.patch.cut_triangle[1] = 12;
  record::RunHeader header = test::make_header(3, 1, 3, 1);
  header.profile_points = 0;
  const auto patch = nlohmann::json::parse(frame_json(frame, header)).at("patch");
  EXPECT_EQ(patch.at("count"), 2);
  EXPECT_EQ(patch.at("moved"), "BwAAAHARAQABAP7/AwD/fwAA//8=")
      << "the same bytes as in the page's own test";
  EXPECT_EQ(patch.at("cut_total"), 40);
  EXPECT_EQ(patch.at("cut"), (std::vector<int>{11, 12}));
  header.profile_points = 3;
  EXPECT_FALSE(nlohmann::json::parse(frame_json(frame, header)).contains("patch"));
}

TEST(FrameJson, StaysInItsLengthWithAFullPatchAndEverySiteHeld) {
  record::Frame frame = longest_frame();
  frame.patch.vertex_count = firmware::protocol::kMaxPatchVertices;
  frame.patch.cut_total = 4'000'000;  // of the largest mesh that check_header lets pass
  frame.patch.cut_count = firmware::protocol::kMaxCutsReported;
  for (auto& triangle : frame.patch.cut_triangle) triangle = 3'999'999;
  record::RunHeader header = busiest_header();
  header.profile_points = 0;
  header.organ_vertices = header.organ_triangles = 4'000'000;
  ASSERT_EQ(message_of(record::check_header(header)), "");
  ASSERT_EQ(message_of(record::check_frame(frame, header)), "");
  const std::string text = frame_json(frame, header);
  EXPECT_LE(text.size(), kMaxFrameJsonBytes);
  EXPECT_GT(text.size(), kMaxFrameJsonBytes / 2) << "patch and contacts are really in it";
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(CheckFrame, RefusesPatchesThatNameWhatIsNotThere) {
  const record::RunHeader header = test::make_header(3, 2, 3, 1);
  record::Frame good{};
  good.patch.vertex_count = 2;
  good.patch.vertex[1] = 2;
  good.patch.cut_total = good.patch.cut_count = 2;
  good.patch.cut_triangle[1] = 1;
  EXPECT_EQ(message_of(record::check_frame(good, header)), "");
  const auto refuses = [&](auto spoil) {
    record::Frame frame = good;
    spoil(frame);
    return record::check_frame(frame, header).has_value();
  };
  EXPECT_TRUE(refuses([](record::Frame& f) { f.patch.vertex[1] = 3; }));
  EXPECT_TRUE(refuses([](record::Frame& f) { f.patch.cut_triangle[1] = 2; }));
  EXPECT_TRUE(refuses(
      [](record::Frame& f) { f.patch.vertex_count = firmware::protocol::kMaxPatchVertices + 1; }));
  EXPECT_TRUE(refuses(
      [](record::Frame& f) { f.patch.cut_count = firmware::protocol::kMaxCutsReported + 1; }));
  EXPECT_TRUE(refuses([](record::Frame& f) { f.patch.cut_total = 1; }));
  EXPECT_TRUE(refuses([](record::Frame& f) { f.patch.cut_total = 3; }));
  EXPECT_TRUE(refuses([](record::Frame& f) { f.state = firmware::loop::State{4}; }));
  EXPECT_TRUE(refuses([](record::Frame& f) { f.contact[3].state = model::ContactState{4}; }));
}

}  // namespace tact::host::server::frame_json_test
