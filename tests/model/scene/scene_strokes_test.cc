// SPDX-License-Identifier: Apache-2.0
// Strokes become way points: where the hand wants the tool's origin to be, and when.
#include "model/scene/scene_strokes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/scene/scene.h"

namespace tact::model::scene::scene_strokes_test {

constexpr contact::ProbeSphere kSphere{.offset_m = {}, .radius_m = 0.005};  // reaches 5 mm
constexpr Vec3 kHome_m{0.0, 0.0, 0.06};
constexpr Vec3 kSite_m{0.01, 0.02, 0.03};
constexpr Limits kLimits{.workspace_radius_m = 0.18, .workspace_half_length_m = 0.15};

struct Written {
  std::vector<HandWaypoint> path;
  std::optional<Error> problem;
};

Written write(std::vector<Stroke> strokes, bool repeat = false,
              const contact::ProbeSphere& sphere = kSphere, const Vec3& handle_m = {}) {
  const reader::SceneDocument document;
  reader::SceneVisit visit(&document);
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const auto line = static_cast<std::uint32_t>(i + 1);
    strokes[i].position = {"s:" + std::to_string(line), line};
  }
  const HandScript script{kHome_m, kSite_m, {0, 0, -2}, handle_m, repeat, strokes, {}};
  auto path = way_points(script, std::span(&sphere, 1), kLimits, visit);
  return {path, visit.problem()};
}

Stroke press(double depth_m, double duration_s) {
  return {.action = Action::kPress, .duration_s = duration_s, .depth_m = depth_m};
}
Stroke slide(const Vec3& offset_m) {
  return {.action = Action::kSlide, .duration_s = 1.0, .offset_m = offset_m};
}
Stroke pull(double height_m) {
  return {.action = Action::kPull, .duration_s = 1.0, .height_m = height_m};
}
const Stroke kHold{.action = Action::kHold, .duration_s = 2.0};
const Stroke kGrip{.action = Action::kGrip, .duration_s = 0.5};
const Stroke kRelease{.action = Action::kRelease, .duration_s = 2.0};

Stroke turn(const Vec3& axis, double angle_rad, bool about_handle = false) {
  return {.action = Action::kTurn,
          .duration_s = 1.0,
          .axis = axis,
          .angle_rad = angle_rad,
          .about_handle = about_handle};
}
/// Where a point of the tool is, in the tool's frame with the handle as its origin.
Vec3 point_W_m(const HandWaypoint& at, const Vec3& p) {
  return at.position_m + rotate(quat_from_rotation_vector(at.rotation_rad), p);
}

void expect_at(const HandWaypoint& p, double time_s, const Vec3& position_m, double grip_ratio) {
  EXPECT_NEAR(p.time_s, time_s, 1e-12);
  EXPECT_NEAR(norm(p.position_m - position_m), 0.0, 1e-15);
  EXPECT_EQ(p.grip_ratio, grip_ratio);
  EXPECT_EQ(p.rotation_rad, Vec3{});
}

TEST(Strokes, StartAtHomeWithAnOpenGrip) {
  const Written w = write({});
  ASSERT_EQ(w.path.size(), 1u);
  expect_at(w.path[0], 0.0, kHome_m, 0.0);
  EXPECT_FALSE(w.problem);
}

TEST(Strokes, PressOfNoDepthEndsAtTheSurface) {
  // Origin 5 mm above the site: the tool extends 5 mm.
  const Written w = write({press(0.0, 1.5)});
  ASSERT_EQ(w.path.size(), 2u);
  expect_at(w.path[1], 1.5, kSite_m + Vec3{0, 0, 0.005}, 0.0);
}

TEST(Strokes, PressGoesAsDeepAsItSays) {
  expect_at(write({press(0.01, 1.0)}).path[1], 1.0, kSite_m + Vec3{0, 0, -0.005}, 0.0);
}

TEST(Strokes, HoldStays) {
  expect_at(write({press(0.01, 1.0), kHold}).path[2], 3.0, kSite_m + Vec3{0, 0, -0.005}, 0.0);
}

TEST(Strokes, SlidesAddUpAndKeepTheDepth) {
  const Written w = write({press(0.01, 1.0), slide({0, 0.02, 0}), slide({0.01, 0, 0})});
  expect_at(w.path[2], 2.0, kSite_m + Vec3{0, 0.02, -0.005}, 0.0);
  expect_at(w.path[3], 3.0, kSite_m + Vec3{0.01, 0.02, -0.005}, 0.0);
}

TEST(Strokes, PressAfterASlideGoesDownWhereTheToolIs) {
  const Written w = write({press(0.01, 1.0), slide({0, 0.02, 0}), press(0.0, 1.0)});
  expect_at(w.path[3], 3.0, kSite_m + Vec3{0, 0.02, 0.005}, 0.0);
}

TEST(Strokes, PressAfterAReleaseGoesToTheSiteAgain) {
  const Written w = write({press(0.01, 1.0), slide({0, 0.02, 0}), kRelease, press(0.0, 1.0)});
  expect_at(w.path.back(), 5.0, kSite_m + Vec3{0, 0, 0.005}, 0.0);
}

TEST(Strokes, GripClosesWhereTheToolIs) {
  const Written w = write({press(0.01, 1.0), kGrip});
  expect_at(w.path[2], 1.5, kSite_m + Vec3{0, 0, -0.005}, 1.0);
}

TEST(Strokes, PullMovesOutwardWithTheGripClosed) {
  const Written w = write({press(0.01, 1.0), kGrip, pull(0.008)});
  expect_at(w.path[3], 2.5, kSite_m + Vec3{0, 0, 0.013}, 1.0);
}

TEST(Strokes, TearIsAPullThatGoesFarther) {
  Stroke tear = pull(0.025);
  tear.action = Action::kTear;
  expect_at(write({press(0.0, 1.0), kGrip, tear}).path[3], 2.5, kSite_m + Vec3{0, 0, 0.03}, 1.0);
}

TEST(Strokes, ReleaseOpensTheGripBeforeItMoves) {
  const Written w = write({press(0.0, 1.0), kGrip, kRelease});
  ASSERT_EQ(w.path.size(), 5u);
  expect_at(w.path[3], 2.0, kSite_m + Vec3{0, 0, 0.005}, 0.0);  // a quarter of 2 s after the grip
  expect_at(w.path[4], 3.5, kHome_m, 0.0);
  EXPECT_EQ(write({press(0.0, 1.0), kRelease}).path.size(), 3u) << "an open grip just leaves";
}

// A tool of 93 mm: its tip is below the point that the hand holds.
constexpr contact::ProbeSphere kJaw{.offset_m = {0, 0, 0.004}, .radius_m = 0.004};
constexpr Vec3 kHandle_m{0, 0, 0.093};
constexpr Vec3 kTip_m{0, 0, 0.004 - 0.093};  // from the handle

TEST(Strokes, TurnAboutTheTipLeavesItInPlaceOnTheWholeWay) {
  const Written w = write({press(0.01, 1.0), turn({0, 3, 0}, 0.3)}, false, kJaw, kHandle_m);
  ASSERT_FALSE(w.problem) << w.problem->message;
  const Vec3 tip_m = point_W_m(w.path[1], kTip_m);
  EXPECT_LT(norm(tip_m - (kSite_m + Vec3{0, 0, 0.004 - 0.01})), 1e-15);
  for (double t = 1.0; t <= 2.0; t += 0.125)
    EXPECT_LT(norm(point_W_m(hand_target(w.path, false, t), kTip_m) - tip_m), 1e-15) << t;
  EXPECT_LT(norm(w.path[2].rotation_rad - Vec3{0, 0.3, 0}), 1e-15);
  EXPECT_NEAR(w.path[2].position_m.x, tip_m.x + 0.089 * std::sin(0.3), 1e-12) << "the handle goes";
}

TEST(Strokes, TurnAboutTheHandleLeavesItInPlace) {
  const Written w = write({press(0.01, 1.0), turn({0, 1, 0}, 0.3, true)}, false, kJaw, kHandle_m);
  EXPECT_LT(norm(hand_target(w.path, false, 1.5).position_m - w.path[1].position_m), 1e-15);
  EXPECT_NEAR(point_W_m(w.path[2], kTip_m).x, kSite_m.x - 0.089 * std::sin(0.3), 1e-12);
}

TEST(Strokes, TurnsAreCountedFromRestAndAReleaseTurnsBack) {
  const Written w = write({turn({0, 0, 1}, 0.2), turn({1, 0, 0}, 0.1), kHold, kRelease}, true);
  EXPECT_EQ(w.path[2].rotation_rad, (Vec3{0.1, 0, 0}));
  EXPECT_EQ(w.path[3].rotation_rad, (Vec3{0.1, 0, 0}));
  expect_at(w.path[4], 6.0, kHome_m, 0.0);
  EXPECT_FALSE(w.problem) << w.problem->message;
}

TEST(Strokes, PullAfterATurnGoesUpWhereTheTipIsWithItsReach) {
  // The handle goes aside, and the jaw's centre is no longer straight above the tool's origin.
  const Written w =
      write({press(0.0, 1.0), kGrip, turn({0, 1, 0}, 0.3), pull(0.008)}, false, kJaw, kHandle_m);
  const Vec3 centre_m = point_W_m(w.path[3], kTip_m);
  EXPECT_LT(norm(centre_m - (kSite_m + Vec3{0, 0, 0.004})), 1e-15);
  EXPECT_LT(norm(point_W_m(w.path[4], kTip_m) - centre_m - Vec3{0, 0, 0.008}), 1e-15);
}

TEST(Strokes, RefuseAHandleOutsideTheWorkspace) {
  const Written w = write({press(0.0, 1.0)}, false, kJaw, {0, 0.17, -0.05});
  ASSERT_TRUE(w.problem);
  EXPECT_NE(w.problem->message.find("(0.0100, 0.1900, -0.0200) m, outside"), std::string::npos)
      << w.problem->message;
}

TEST(Strokes, TimesAlwaysAscend) {
  const Written w = write({press(0.01, 0.05), kGrip, pull(0.0), kRelease, kHold, kRelease}, true);
  ASSERT_FALSE(w.problem) << w.problem->message;
  for (std::size_t i = 1; i < w.path.size(); ++i)
    EXPECT_GT(w.path[i].time_s, w.path[i - 1].time_s) << i;
}

TEST(Strokes, RefuseToPullWithAnOpenGrip) {
  const std::string said =
      "s:4: hand.stroke.3 pulls with an open grip; put a grip stroke before it";
  const Written w = write({press(0.0, 1.0), kGrip, kRelease, pull(0.01)});
  ASSERT_TRUE(w.problem);
  EXPECT_EQ(w.problem->message, said);
}

TEST(Strokes, RefuseToLeaveTheWorkspace) {
  const Vec3 step_m{0.1, 0, 0};
  const Written w = write({press(0.0, 1.0), slide(step_m), slide(step_m)});
  ASSERT_TRUE(w.problem);
  EXPECT_EQ(w.problem->message,
            "s:3: hand.stroke.2 ends at (0.2100, 0.0200, 0.0350) m, outside the workspace of "
            "[limits]; move it inside");
  EXPECT_FALSE(write({press(0.0, 1.0), slide(step_m)}).problem);
  const Vec3 side_m{0, 0.1, 0};  // radius: hypot(0.22, 0.035) > 0.18
  EXPECT_TRUE(write({press(0.0, 1.0), slide(side_m), slide(side_m)}).problem);
}

TEST(Strokes, RefuseToRepeatFromAnywhereButHome) {
  const Written w = write({press(0.0, 1.0), kHold}, true);
  ASSERT_TRUE(w.problem);
  EXPECT_EQ(w.problem->message,
            "s:2: hand.repeat would make the hand jump home from here; end with a release stroke");
  EXPECT_FALSE(write({press(0.0, 1.0), kRelease}, true).problem);
  EXPECT_FALSE(write({press(0.0, 1.0), kHold}, false).problem);
}

TEST(Strokes, RefuseAHomeOutsideTheWorkspace) {
  const std::string plain = TACT_SOURCE_DIR "/tests/data/scenes/plain.toml";
  const Result<Scene> scene = load_scene(plain, {"hand.home_m=[0, 0, 0.19]"});
  ASSERT_FALSE(scene);
  EXPECT_EQ(
      scene.error().message,
      "--set hand.home_m=[0, 0, 0.19]: hand.home_m is (0.0000, 0.0000, 0.1900) m, outside the "
      "workspace of [limits]; move it inside");
}

TEST(Strokes, SayThatAPlaceIsOfTheHandleWhereThatIsNotTheOrigin) {
  const std::string plain = TACT_SOURCE_DIR "/tests/data/scenes/plain.toml";
  const auto refusal = [&](const std::string& home, const std::string& handle) {
    const Result<Scene> scene =
        load_scene(plain, {"hand.home_m=" + home, "tool.handle_m=" + handle});
    return scene ? std::string() : scene.error().message;
  };
  const std::string home = refusal("[0, 0, 0.09]", "[0, 0, 0.1]");
  EXPECT_NE(home.find("the handle at hand.home_m + tool.handle_m is (0.0000, 0.0000, 0.1900) m"),
            std::string::npos)
      << home;
  const std::string stroke = refusal("[0, 0, 0.06]", "[0, 0.15, 0]");
  EXPECT_NE(stroke.find(" ends with the handle at ("), std::string::npos) << stroke;
}

TEST(Strokes, ReachIsThatOfTheOutermostSphere) {
  const contact::ProbeSphere spheres[] = {{{0, 0.004, 0.004}, 0.004}, {{0, 0, -0.001}, 0.002}};
  EXPECT_NEAR(reach_m(spheres, {0, 0, -1}), 0.003, 1e-15);  // 0.001 + 0.002
  EXPECT_NEAR(reach_m(spheres, {0, 0, 1}), 0.008, 1e-15);   // 0.004 + 0.004
  EXPECT_NEAR(reach_m(spheres, {0, -1, 0}), 0.002, 1e-15);  // -0.004 + 0.004, 0 + 0.002
}

}  // namespace tact::model::scene::scene_strokes_test
