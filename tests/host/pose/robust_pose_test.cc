// SPDX-License-Identifier: Apache-2.0
#include "host/pose/robust_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "host/pose/one_euro.h"
#include "tests/support/tracking_views.h"

namespace tact::host::pose::robust_pose_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOutlier_px = 3.0;
const tracking::TrackingCamera kEye = test::camera("front", Pose{});

/// Tangents of sweep angles: the same eye with a focal length of 1.
constexpr Camera kSweep{.fx_px = 1.0, .fy_px = 1.0};

struct View {
  Camera lens = kEye.lens;
  std::vector<Vector3d> points_m;
  std::vector<Vector2d> pixels_px;
  Pose truth{};
  /// One pixel of kEye in the numbers of this lens.
  double unit() const { return lens.fx_px / kEye.lens.fx_px; }
  PoseEstimate estimate() const {
    return robust_pose(lens, points_m, pixels_px, kOutlier_px * unit());
  }
};

class Views {
 public:
  explicit Views(const Camera& lens = kEye.lens) : lens_(lens) {}
  View next(std::size_t markers = 8, double scale = 1.0) {
    View out;
    out.lens = lens_;
    out.truth.rotation = Eigen::Quaterniond{normal(), normal(), normal(), normal()}.normalized();
    out.truth.position_m = Vector3d{0.3 * side(), 0.3 * side(), 2.0};
    for (const tracking::BodyMarker& marker : test::eight_markers())
      if (out.points_m.size() < markers) out.points_m.push_back(scale * marker.position_m);
    look(out);
    return out;
  }
  void look(View& view) {
    view.pixels_px.clear();
    for (const Vector3d& p : view.points_m) {
      const Vector3d x = to_world(view.truth, p);
      const Vector2d noise_px{0.5 * normal(), 0.5 * normal()};  // braces fix the order of draws
      const Vector2d px(lens_.fx_px * x.x() / x.z() + lens_.cx_px,
                        lens_.fy_px * x.y() / x.z() + lens_.cy_px);
      view.pixels_px.push_back(px + view.unit() * noise_px);
    }
  }
  double side() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  double normal() { return std::normal_distribution<double>()(random_); }
  std::size_t any(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

 private:
  Camera lens_;
  std::mt19937 random_{11};
};

double off_m(const Pose& got, const Pose& truth) {
  return (got.position_m - truth.position_m).norm();
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

class WrongMarker : public ::testing::TestWithParam<Camera> {};

TEST_P(WrongMarker, OneWrongMarkerOfEightIsLeftOut) {
  Views views(GetParam());
  std::vector<double> with_m, without_m;
  for (int i = 0; i < 300; ++i) {
    View view = views.next();
    without_m.push_back(off_m(view.estimate().pose, view.truth));
    const std::size_t wrong = views.any(8);
    view.pixels_px[wrong] += view.unit() * Vector2d(40.0 + 200.0 * views.side(), 60.0);
    const PoseEstimate got = view.estimate();
    ASSERT_EQ(got.status, PoseStatus::kOk) << i;
    EXPECT_LT(got.pose.rotation.angularDistance(view.truth.rotation), 0.2) << i;
    EXPECT_LT(got.rms_px, kOutlier_px * view.unit());
    with_m.push_back(off_m(got.pose, view.truth));
  }
  // Seven good markers instead of eight.
  EXPECT_LT(quantile(with_m, 0.5), 1.5 * quantile(without_m, 0.5));
  EXPECT_LT(quantile(with_m, 0.95), 1.5 * quantile(without_m, 0.95));
}

INSTANTIATE_TEST_SUITE_P(PixelsAndSweeps, WrongMarker, ::testing::Values(kEye.lens, kSweep));

TEST(RobustPose, TwoMarkersThatChangedTheirNamesAreLeftOut) {
  Views views;
  for (int i = 0; i < 100; ++i) {
    View view = views.next();
    std::swap(view.pixels_px[0], view.pixels_px[1 + views.any(7)]);
    const PoseEstimate got = view.estimate();
    ASSERT_EQ(got.status, PoseStatus::kOk) << i;
    EXPECT_LT(got.pose.rotation.angularDistance(view.truth.rotation), 0.2) << i;
  }
}

TEST(RobustPose, WithSixMarkersAWrongOneShowsAsNoPose) {
  Views views;
  int refused = 0;
  for (int i = 0; i < 100; ++i) {
    View view = views.next(6);
    EXPECT_EQ(view.estimate().status, PoseStatus::kOk) << i;
    view.pixels_px[views.any(6)] += Vector2d(60.0, 60.0);
    if (view.estimate().status == PoseStatus::kNoPose) ++refused;
  }
  EXPECT_EQ(refused, 100);
}

TEST(RobustPose, MarkersAllWrongGiveNoPose) {
  Views views;
  for (int i = 0; i < 50; ++i) {
    View view = views.next();
    for (Vector2d& px : view.pixels_px) px += 100.0 * Vector2d(views.side(), views.side());
    EXPECT_EQ(view.estimate().status, PoseStatus::kNoPose) << i;
  }
}

TEST(RobustPose, IsTheSameInEveryRun) {
  Views views;
  View view = views.next();
  view.pixels_px[3] += Vector2d(30.0, -50.0);
  const PoseEstimate first = view.estimate();
  for (int i = 0; i < 5; ++i) {
    views.next().estimate();
    const PoseEstimate again = view.estimate();
    EXPECT_EQ(again.pose.position_m, first.pose.position_m);
    EXPECT_EQ(again.pose.rotation.coeffs(), first.pose.rotation.coeffs());
  }
}

TEST(RobustPose, TooFewDegenerateOrNanPointsKeepTheirStatus) {
  View view = Views().next(3);
  EXPECT_EQ(view.estimate().status, PoseStatus::kTooFewPoints);
  view = Views().next();
  for (std::size_t i = 0; i < 8; ++i) view.points_m[i] = static_cast<double>(i) * Vector3d::Ones();
  EXPECT_EQ(view.estimate().status, PoseStatus::kDegenerate);
  view = Views().next();
  view.pixels_px[2].x() = std::nan("");
  EXPECT_EQ(view.estimate().status, PoseStatus::kInvalid);
}

// 0.5 px of noise at 2 m, f = 1200 px, eight markers. Depth is what one camera sees worst: its
// error goes with distance squared over the size of the body, 15 cm here.
TEST(RobustPose, HalfAPixelOfNoiseMovesABodyAt2mByLessThan3mm) {
  Views views;
  std::vector<double> raw_m, across_m, shown_m;
  for (int i = 0; i < 100; ++i) {
    View view = views.next();
    PoseFilter filter;
    Pose shown;
    for (int k = 0; k < 120; ++k) {  // two seconds at rest
      views.look(view);
      const PoseEstimate got = view.estimate();
      ASSERT_EQ(got.status, PoseStatus::kOk);
      shown = filter.next(got.pose, k / 60.0);
      const Vector3d off = got.pose.position_m - view.truth.position_m;
      const Vector3d sight = view.truth.position_m.normalized();
      raw_m.push_back(off.norm());
      across_m.push_back((off - off.dot(sight) * sight).norm());
    }
    shown_m.push_back(off_m(shown, view.truth));
  }
  EXPECT_LT(quantile(shown_m, 0.5), 0.003);    // the median
  EXPECT_LT(quantile(across_m, 0.95), 0.002);  // what moves in the picture
  EXPECT_LT(quantile(raw_m, 0.5), 0.009);      // and what the filter is for
}

TEST(RobustPose, ABodyOfFortyCentimetresNeedsNoFilterForThreeMillimetres) {
  Views views;
  std::vector<double> raw_m;
  for (int i = 0; i < 500; ++i) {
    const View view = views.next(8, 40.0 / 15.0);
    raw_m.push_back(off_m(view.estimate().pose, view.truth));
  }
  EXPECT_LT(quantile(raw_m, 0.5), 0.003);
  EXPECT_LT(quantile(raw_m, 0.95), 0.010);
}

}  // namespace tact::host::pose::robust_pose_test
