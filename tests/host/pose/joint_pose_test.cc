// SPDX-License-Identifier: Apache-2.0
#include "host/pose/joint_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "host/pose/robust_pose.h"
#include "tests/support/tracking_views.h"

namespace tact::host::pose::joint_pose_test {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
const tracking::TrackingCamera kPixels = test::camera("p", Pose{});

tracking::TrackingCamera sweep() {
  tracking::TrackingCamera out = kPixels;
  out.lens = {.fx_px = 1.0, .fy_px = 1.0};
  out.outlier_px = 0.0025;
  return out;
}

/// What a camera sees, and its stated pose.
struct Picture {
  tracking::TrackingCamera camera;
  Pose eye{};
  std::vector<Vector3d> points_m;
  std::vector<Vector2d> pixels_px;

  PoseEstimate alone() const {
    return robust_pose(camera.lens, points_m, pixels_px, camera.outlier_px);
  }
  BodyView view() const {
    BodyView out = body_view(camera.lens, points_m, pixels_px, camera.outlier_px, alone().pose);
    out.eye = eye;
    return out;
  }
};

struct Scene {
  Pose truth{};
  Picture a, b;
  PoseEstimate joint() const {
    const BodyView views[] = {a.view(), b.view()};
    return joint_pose(views);
  }
};

double off_m(const Pose& got, const Pose& truth) {
  return (got.position_m - truth.position_m).norm();
}

double distance(const Pose& got, const Pose& truth) {
  return off_m(got, truth) + got.rotation.angularDistance(truth.rotation);
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// Two cameras 2 m from a body of 15 cm, 30 to 120 degrees between their lines of sight.
class Scenes {
 public:
  Scene next(double noise_px = 0.5, const tracking::TrackingCamera& second = kPixels) {
    Scene out;
    out.truth = {.rotation = Quaterniond(normal(), normal(), normal(), normal()).normalized(),
                 .position_m = Vector3d(side(), side(), side())};
    const Vector3d ahead = Vector3d(normal(), normal(), normal()).normalized();
    const Vector3d across = ahead.cross(Vector3d(normal(), normal(), normal()));
    const double angle_rad = (75.0 + 45.0 * side()) * kDegree;
    const Vector3d ahead_b = test::turn(angle_rad, across) * ahead;
    out.a = look(kPixels, towards(out.truth, ahead), out.truth, noise_px);
    out.b = look(second, towards(out.truth, ahead_b), out.truth, noise_px);
    return out;
  }
  Picture look(const tracking::TrackingCamera& camera, const Pose& eye, const Pose& body,
               double noise_px) {
    Picture out{.camera = camera, .eye = eye, .points_m = {}, .pixels_px = {}};
    const double noise = noise_px * camera.lens.fx_px / 1200.0;  // of a sweep: as many tangents
    const tracking::Observation seen = test::look(camera, eye, "b", body, 0.0, 0);
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
      out.points_m.push_back(test::eight_markers()[i].position_m);
      out.pixels_px.emplace_back(seen.points[i].pixel_px + noise * Vector2d(normal(), normal()));
    }
    return out;
  }
  double side() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  double normal() { return std::normal_distribution<double>()(random_); }

 private:
  /// Not in the middle of the picture, and rolled.
  Pose towards(const Pose& body, const Vector3d& ahead) {
    const Vector3d beside = 0.3 * ahead.cross(Vector3d(side(), side(), side()));
    return test::eye_towards(body.position_m + beside, ahead, 2.0, 3.0 * side());
  }
  std::mt19937 random_{5};
};

TEST(JointPose, HalfAPixelAtTwoMetresMovesARawPoseByLessThanThreeMillimetres) {
  Scenes scenes;
  std::vector<double> joint_m, alone_m, turn_rad, alone_rad;
  for (int i = 0; i < 3000; ++i) {
    const Scene scene = scenes.next();
    const PoseEstimate joint = scene.joint(), alone = scene.a.alone();
    ASSERT_EQ(joint.status, PoseStatus::kOk) << i;
    const Pose single = drive(scene.a.eye, alone.pose);
    joint_m.push_back(off_m(joint.pose, scene.truth));
    alone_m.push_back(off_m(single, scene.truth));
    turn_rad.push_back(joint.pose.rotation.angularDistance(scene.truth.rotation));
    alone_rad.push_back(single.rotation.angularDistance(scene.truth.rotation));
  }
  EXPECT_LT(quantile(joint_m, 0.5), 0.003);
  EXPECT_LT(quantile(joint_m, 0.95), 0.003);
  EXPECT_GT(quantile(joint_m, 0.5), 0.0001);  // there is noise
  EXPECT_GT(quantile(alone_m, 0.5), 0.003);   // what one camera cannot
  EXPECT_LT(quantile(turn_rad, 0.5), quantile(alone_rad, 0.5));
}

TEST(JointPose, IsExactWithoutNoise) {
  Scenes scenes;
  for (const tracking::TrackingCamera& second : {kPixels, sweep()}) {
    for (int i = 0; i < 200; ++i) {
      const Scene scene = scenes.next(0.0, second);
      const PoseEstimate joint = scene.joint();
      ASSERT_EQ(joint.status, PoseStatus::kOk) << i;
      EXPECT_LT(distance(joint.pose, scene.truth), 1e-9) << i;
      EXPECT_LT(joint.rms_px, 1e-6);
    }
  }
}

TEST(JointPose, FindsTheTruthFromAStartThatIsOff) {
  Scenes scenes;
  for (int i = 0; i < 200; ++i) {
    const Scene scene = scenes.next(0.0);
    BodyView views[] = {scene.a.view(), scene.b.view()};
    for (BodyView& view : views) {
      view.alone.position_m *= 1.05;
      view.alone.rotation = view.alone.rotation * test::turn(0.2, {1, scenes.side(), 0});
    }
    const PoseEstimate joint = joint_pose(views);
    ASSERT_EQ(joint.status, PoseStatus::kOk) << i;
    EXPECT_LT(distance(joint.pose, scene.truth), 1e-9) << i;
  }
}

TEST(JointPose, IsNeverWorseThanItsBestStart) {
  Scenes scenes;
  int contradicted = 0;  // by noise alone: rare
  for (int i = 0; i < 500; ++i) {
    const Scene scene = scenes.next(i % 2 == 0 ? 0.5 : 0.8);
    const BodyView views[] = {scene.a.view(), scene.b.view()};
    std::vector<MarkerView> markers;
    for (const BodyView& view : views) {
      markers.push_back({.camera = {.fx_px = 1.0, .fy_px = 1.0},
                         .eye = view.eye,
                         .points_m = view.points_m,
                         .pixels_px = view.tangents});
    }
    const PoseEstimate joint = joint_pose(views);
    if (joint.status != PoseStatus::kOk) {
      ++contradicted;
      continue;
    }
    EXPECT_NEAR(joint.rms_px, 1200.0 * reprojection_rms_px(markers, joint.pose), 1e-9);
    for (const BodyView& view : views) {
      const double start = reprojection_rms_px(markers, drive(view.eye, view.alone));
      EXPECT_LE(joint.rms_px, 1200.0 * start * (1.0 + 1e-9)) << i;
    }
  }
  EXPECT_LE(contradicted, 5);
}

TEST(JointPose, ASweepAndACameraOfPixelsCountAlike) {
  // The same noise in angles: whichever view is reported in pixels or in tangents, the pose is the
  // same.
  Scenes scenes;
  for (int i = 0; i < 50; ++i) {
    const Scene scene = scenes.next();
    Scene mixed = scene;
    mixed.b.camera = sweep();
    for (Vector2d& px : mixed.b.pixels_px)
      px = Vector2d((px.x() - 960.0) / 1200.0, (px.y() - 540.0) / 1200.0);
    EXPECT_LT(distance(mixed.joint().pose, scene.joint().pose), 1e-7) << i;
    EXPECT_NEAR(mixed.joint().rms_px, scene.joint().rms_px, 1e-6);  // px of the first camera
  }
}

TEST(JointPose, AWrongMarkerInOneViewBendsNothing) {
  Scenes scenes;
  std::vector<double> with_m;
  for (int i = 0; i < 500; ++i) {
    Scene scene = scenes.next();
    scene.b.pixels_px[static_cast<std::size_t>(i % 8)] +=
        Vector2d(40.0 + 30.0 * scenes.side(), 50.0);
    const PoseEstimate joint = scene.joint();
    ASSERT_EQ(joint.status, PoseStatus::kOk) << i;
    with_m.push_back(off_m(joint.pose, scene.truth));
  }
  EXPECT_LT(quantile(with_m, 0.95), 0.003);
}

TEST(JointPose, ViewsThatContradictEachOtherGiveNoPose) {
  Scenes scenes;
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    Scene scene = scenes.next();
    const Vector3d sight = scene.b.eye.rotation * Vector3d::UnitZ();
    // Across what it sees: 10 cm are 60 px.
    const Vector3d across = sight.cross(scene.a.eye.rotation * Vector3d::UnitZ()).normalized();
    scene.b.eye.position_m += 0.1 * across;
    EXPECT_EQ(scene.joint().status, PoseStatus::kNoPose) << i;
    scene.b.eye.position_m -= 0.1 * across;
    EXPECT_EQ(scene.joint().status, PoseStatus::kOk) << i;
    // Along what the other sees, which takes it for depth: only the body's size shows it.
    const Vector3d depth = across.cross(sight).normalized();
    scene.b.eye.position_m += 0.1 * depth;
    refused += scene.joint().status == PoseStatus::kNoPose ? 1 : 0;
  }
  EXPECT_GT(refused, 290);
}

TEST(JointPose, OneViewGivesWhatItGivesAlone) {
  Scenes scenes;
  const Scene scene = scenes.next();
  const BodyView view = scene.a.view();
  const PoseEstimate joint = joint_pose({&view, 1});
  ASSERT_EQ(joint.status, PoseStatus::kOk);
  EXPECT_LT(distance(joint.pose, drive(scene.a.eye, scene.a.alone().pose)), 1e-6);
  EXPECT_NEAR(joint.rms_px, scene.a.alone().rms_px, 1e-6);
  EXPECT_EQ(joint_pose({}).status, PoseStatus::kInvalid);
}

}  // namespace tact::host::pose::joint_pose_test
