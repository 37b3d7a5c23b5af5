// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/tracking_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/message.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::tracking_setup_test {

using tests::message_of;

class SetupFile : public ::testing::Test {
 protected:
  SetupFile() : folder_("/tmp/tact-setup-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~SetupFile() override { std::filesystem::remove_all(folder_); }

  std::string load(const std::string& text) {
    path_ = folder_ + "/desk.tracking.toml";
    test::write_file(path_, text);
    const model::Result<TrackingSetup> read = load_tracking_setup(path_);
    setup_ = read ? *read : TrackingSetup{};
    return message_of(read);
  }
  static std::string good(const std::string& more = {}) {
    return test::description("udp_port = 8322", {{"head", "head"}, {"t", "tool"}}, more);
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string out = good();
    const std::size_t at = out.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return out.replace(at, from.size(), to);
  }

  std::string folder_, path_;
  TrackingSetup setup_;
};

TEST_F(SetupFile, IsReadAsWritten) {
  ASSERT_EQ(load(good("[registration]\nposition_m = [1, 2.0, 3]\nrotation_wxyz = [0, 0, 0, 2]\n")),
            "");
  EXPECT_EQ(setup_.udp_port, 8322);
  ASSERT_EQ(setup_.cameras.size(), 1u);
  EXPECT_EQ(setup_.cameras[0].name, "front");
  EXPECT_EQ(setup_.cameras[0].lens.fx_px, 1200.0);
  EXPECT_EQ(setup_.cameras[0].lens.cy_px, 540.0);
  EXPECT_EQ(setup_.cameras[0].outlier_px, 3.0);
  EXPECT_TRUE(setup_.cameras[0].pose);
  ASSERT_EQ(setup_.bodies.size(), 2u);
  EXPECT_EQ(setup_.bodies[0].role, BodyRole::kHead);
  EXPECT_EQ(setup_.bodies[0].markers.size(), 8u);
  EXPECT_EQ(setup_.bodies[0].markers[2].position_m, Eigen::Vector3d(.02, -.06, .04));
  ASSERT_NE(setup_.body_of(BodyRole::kTool), nullptr);
  EXPECT_EQ(setup_.body_of(BodyRole::kTool)->tip_m, Eigen::Vector3d(.1, 0, 0));
  EXPECT_EQ(setup_.body_of(BodyRole::kWaist), nullptr);
  EXPECT_EQ(setup_.registration.position_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(setup_.registration.rotation.z(), 1.0);
  EXPECT_EQ(setup_.registered_by, path_);
}

TEST_F(SetupFile, TheOperatorsShoulderIsOptional) {
  ASSERT_EQ(load(good()), "");
  EXPECT_FALSE(setup_.shoulder_m);
  ASSERT_EQ(load(good("[operator]\nshoulder_m = [0.5, 0.2, 0.4]\n")), "");
  EXPECT_EQ(setup_.shoulder_m, Eigen::Vector3d(.5, .2, .4));
  EXPECT_NE(load(good("[operator]\nshoulder_m = [50, 0.2, 0.4]\n")).find("shoulder_m"),
            std::string::npos);
}

TEST_F(SetupFile, ARecordingIsLookedForBesideTheFile) {
  ASSERT_EQ(load(with("udp_port = 8322", "recording = \"a.jsonl\"")), "");
  EXPECT_EQ(setup_.recording, folder_ + "/a.jsonl");
  EXPECT_EQ(setup_.udp_port, 0);
}

TEST_F(SetupFile, ASweepTrackerNeedsNoLens) {
  std::string text =
      with("fx_px = 1200.0\nfy_px = 1200.0\ncx_px = 960.0\ncy_px = 540.0\n", "sweep = true\n");
  ASSERT_EQ(load(text), "");
  EXPECT_EQ(setup_.cameras[0].lens.fx_px, 1.0);
  EXPECT_EQ(setup_.cameras[0].lens.cx_px, 0.0);
  EXPECT_LT(setup_.cameras[0].outlier_px, 0.01);
}

TEST_F(SetupFile, OneLineSaysWhatIsWrongAndWhere) {
  const std::pair<std::string, const char*> cases[] = {
      {with("udp_port = 8322", "udp_port = "), ":2: not TOML"},
      {with("udp_port = 8322", "udp_port = 0"), ":2: input.udp_port = 0 is out of range"},
      {with("udp_port = 8322", "udp_port = 8399.7"), ":2: input.udp_port = 8399.7 is written with"},
      {with("udp_port = 8322", "udp_port = 8322\nrecording = \"a\""), ":2: [input] takes udp_port"},
      {with("udp_port = 8322", "recording = 7"), ":2: input.recording is a number, not text"},
      {with("udp_port = 8322", ""), ":1: [input] takes udp_port"},
      {with("[input]\n", "[inputs]\n"), "inputs is no key here; did you mean input?"},
      {with("fx_px = 1200.0", "fx_px = \"wide\""), ":5: camera.0.fx_px is text"},
      {with("fx_px = 1200.0", "fx_px = -1200.0"), ":5: camera.0.fx_px = -1200 is out"},
      {with("fx_px = 1200.0", "sweep = true\nfx_px = 1200.0"), ":6: a sweep tracker"},
      {with("fx_px = 1200.0", "sweep = true"),
       ":6: a sweep tracker measures tangents; leave fy_px"},
      {with("fx_px = 1200.0\nfy_px = 1200.0\n", "sweep = true\n"), ":6: a sweep tracker measures "},
      {with("fx_px = 1200.0\nfy_px = 1200.0\ncx_px = 960.0\n", "sweep = true\n"),
       ":6: a sweep tracker measures tangents; leave cy_px"},
      {with("fx_px = 1200.0", "sweep = 1\nfx_px = 1200.0"), ":5: camera.0.sweep is a number"},
      {with("position_m = [0.0, 0.0, 0.0]", "position_m = [0.0, 0.0]"),
       ":9: camera.0.position_m has 2"},
      {with("position_m = [0.0, 0.0, 0.0]", "position_m = [0.0, nan, 0.0]"),
       ":9: camera.0.position_m y = nan"},
      {with("[1.0, 0.0, 0.0, 0.0]", "[0.0, 0.0, 0.0, 0.0]"), ":10: rotation_wxyz has no direct"},
      {with("position_m = [0.0, 0.0, 0.0]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n", ""),
       "camera front has no position_m"},
      {with("rotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n", ""), ":4: camera front has no position_m"},
      {with("role = \"head\"", "role = \"nose\""),
       "role = \"nose\" is unknown; allowed: \"head\", "},
      {with("role = \"head\"", "role = \"tool\""), "two bodies have this role"},
      {with("name = \"t\"", "name = \"head\""), "two bodies have this name"},
      {with("name = \"t\"", "name = \"a b\""), "name must be 1 to 32"},
      {with("role = \"head\"", "role = \"head\"\ntip_m = [0.0, 0.0, 0.0]"), "only role = \"tool\""},
      {with("[1, -0.05", "[0, -0.05"), "marker 0 is there twice"},
      {with("[1, -0.05", "[1.5, -0.05"), "id must be a whole number"},
      {with("[1, -0.05", "[1, -50.0"), "more than 10 m"},
      {with("[1, -0.05, 0.04, 0.03]", "[1, -0.05, 0.04]"), "markers_m entry 1: has 3 elements"},
      {with("name = \"front\"", "name = \"front\"\nfocus = 1"),
       ":5: camera.0.focus is no key here"},
      {good("[registration]\nposition_m = [0.0, 0.0, 0.0]\n"),
       "registration.rotation_wxyz is missing"},
      {good("[[camera]]\nname = \"front\"\nsweep = true\n"), "two cameras are called front"},
      {"", "input is missing; allowed: a section [input]"},
      {"[input]\nudp_port = 1\n", "body is missing; allowed: 1 .. 32 sections [[body]]"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string wrong = load(text);
    EXPECT_NE(wrong.find(expected), std::string::npos) << expected << " -> " << wrong;
    EXPECT_TRUE(wrong.starts_with(path_ + ":")) << wrong;
    EXPECT_EQ(wrong.find('\n'), std::string::npos);
  }
  EXPECT_NE(message_of(load_tracking_setup(folder_ + "/none.toml")).find("no such file"),
            std::string::npos);
}

TEST_F(SetupFile, ABodyWithThreeMarkersIsRefused) {
  EXPECT_NE(load("[input]\nudp_port = 1\n[[camera]]\nname = \"c\"\nsweep = true\nposition_m = "
                 "[0,0,0]\nrotation_wxyz = [1,0,0,0]\n[[body]]\nname = \"b\"\nrole = "
                 "\"hand\"\nmarkers_m = [[0,0,0,0],[1,1,0,0],[2,0,1,0]]\n")
                .find(":11: a body takes 4 to 64 markers"),
            std::string::npos);
}

TEST_F(SetupFile, ThirtyTwoCamerasAreTheMost) {
  std::string more;
  const auto add = [&](const std::string& name) {
    more += "[[camera]]\nname = \"" + name +
            "\"\nsweep = true\nposition_m = [0, 0, 0]\nrotation_wxyz = [1, 0, 0, 0]\n";
  };
  for (int i = 1; i < 32; ++i) add("c" + std::to_string(i));
  EXPECT_EQ(load(good(more)), "");
  add("c32");
  const std::string wrong = load(good(more));
  EXPECT_NE(wrong.find("camera has 33 entries; allowed: 1 .. 32 sections"), std::string::npos)
      << wrong;
}

TEST_F(SetupFile, TheFilesOwnRegistrationGoesBeforeTheOneBesideIt) {
  test::write_file(folder_ + "/desk.registration.toml",
                   "[registration]\nposition_m = [9, 9, 9]\nrotation_wxyz = [1, 0, 0, 0]\n");
  ASSERT_EQ(load(good()), "");
  EXPECT_EQ(setup_.registration.position_m.x(), 9.0);
  ASSERT_EQ(load(good("[registration]\nposition_m = [1, 1, 1]\nrotation_wxyz = [1, 0, 0, 0]\n")),
            "");
  EXPECT_EQ(setup_.registration.position_m.x(), 1.0);
  test::write_file(folder_ + "/desk.registration.toml", "[registration]\nposition_m = 3\n");
  EXPECT_NE(load(good()).find("desk.registration.toml:2: registration.position_m"),
            std::string::npos);
}

}  // namespace tact::host::tracking::tracking_setup_test
