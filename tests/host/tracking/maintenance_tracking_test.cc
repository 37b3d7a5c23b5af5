// SPDX-License-Identifier: Apache-2.0
// What the tracker finds in the recording of the scene maintenance, against the poses that it was
// computed from (tests/data/maintenance.truth.csv).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <sstream>

#include "host/tracking/observation.h"
#include "host/tracking/operator_tracker.h"
#include "host/tracking/tracking_setup.h"
#include "tests/support/mesh_files.h"
#include "tests/support/message.h"

namespace tact::host::maintenance_tracking_test {

using tests::message_of;

using Eigen::Quaterniond;
using Eigen::Vector3d;
using tests::read_text;

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";
const std::string kObservations = "maintenance.observations.jsonl";
const std::string kDescription = "maintenance.tracking.toml";

/// A look of the recording, what the tracker made of it, and what was true.
struct Step {
  tracking::Observation seen;
  pose::Pose truth{};
  tracking::TrackedBody body{};  // just after it
};

class MaintenanceTracking : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto setup = tracking::load_tracking_setup(kScenes + kDescription);
    ASSERT_EQ(message_of(setup), "");
    setup_ = *setup;
    std::istringstream lines(read_text(kScenes + kObservations));
    std::istringstream truths(read_text(TACT_SOURCE_DIR "/tests/data/maintenance.truth.csv"));
    std::string line, truth;
    std::getline(truths, truth);  // the names of its columns
    tracking::OperatorTracker tracker(setup_);
    while (std::getline(lines, line)) {
      Step step;
      const auto seen = tracking::parse_observation(line);
      ASSERT_EQ(message_of(seen), "") << line;
      step.seen = *seen;
      ASSERT_TRUE(std::getline(truths, truth));
      step.truth = true_pose(truth, step.seen);
      ASSERT_EQ(message_of(tracker.take(step.seen, step.seen.time_s)), "") << line;
      step.body = tracker.at(step.seen.time_s)[role_of(step.seen.body)];
      steps_.push_back(step);
    }
    EXPECT_FALSE(std::getline(truths, truth));
  }

  static pose::Pose true_pose(const std::string& line, const tracking::Observation& seen) {
    double time_s = 0.0;
    std::array<char, 16> body{};
    Quaterniond q;
    Vector3d p_m;
    EXPECT_EQ(
        std::sscanf(line.c_str(), "%lf,%15[a-z],%lf,%lf,%lf,%lf,%lf,%lf,%lf", &time_s, body.data(),
                    &p_m.x(), &p_m.y(), &p_m.z(), &q.w(), &q.x(), &q.y(), &q.z()),
        9);
    EXPECT_EQ(body.data(), seen.body);
    EXPECT_NEAR(time_s, seen.time_s, 1e-9);
    return {.rotation = q.normalized(), .position_m = p_m};
  }

  static tracking::BodyRole role_of(const std::string& body) {
    const auto it = std::ranges::find(setup_.bodies, body, &tracking::MarkerBody::name);
    return it->role.value();
  }

  static std::vector<const Step*> of(const std::string& body) {
    std::vector<const Step*> out;
    for (const Step& step : steps_)
      if (step.seen.body == body) out.push_back(&step);
    return out;
  }

  static bool is_within(const Step& step, double from_s, double to_s) {
    return step.seen.time_s > from_s - 1e-6 && step.seen.time_s < to_s - 1e-6;
  }

  /// Looks of a body, in this time, that ended in this trouble.
  static int troubles(const std::string& body, tracking::TrackingTrouble trouble, double from_s,
                      double to_s) {
    int out = 0;
    for (const Step* step : of(body))
      out += is_within(*step, from_s, to_s) && step->body.trouble == trouble;
    return out;
  }

  inline static tracking::TrackingSetup setup_;
  inline static std::vector<Step> steps_;
};

TEST_F(MaintenanceTracking, PosesAreWithinThreeMillimetresOfTheTruthInTheMedian) {
  std::vector<double> off_mm, off_deg;
  for (const Step& step : steps_) {
    if (step.body.trouble != tracking::TrackingTrouble::kNone || is_within(step, 25.0, 26.2))
      continue;
    off_mm.push_back(1e3 * (step.body.raw.position_m - step.truth.position_m).norm());
    off_deg.push_back(step.body.raw.rotation.angularDistance(step.truth.rotation) * 180.0 / M_PI);
  }
  ASSERT_GT(off_mm.size(), 2500u);
  std::ranges::sort(off_mm);
  std::ranges::sort(off_deg);
  const auto at = [](const std::vector<double>& v, double share) {
    return v[static_cast<std::size_t>(share * static_cast<double>(v.size()))];
  };
  std::printf("position: median %.2f mm, 95 %% %.2f mm, worst %.1f mm of %zu\n", at(off_mm, 0.5),
              at(off_mm, 0.95), off_mm.back(), off_mm.size());
  std::printf("turn: median %.2f deg, 95 %% %.2f deg\n", at(off_deg, 0.5), at(off_deg, 0.95));
  EXPECT_LT(at(off_mm, 0.5), 3.0);
  EXPECT_GT(at(off_mm, 0.5), 0.5) << "there is noise in it";
  EXPECT_LT(at(off_mm, 0.95), 10.0);
  EXPECT_LT(off_mm.back(), 30.0) << "no wrong marker got into a pose";
  EXPECT_LT(at(off_deg, 0.5), 0.5);
}

TEST_F(MaintenanceTracking, HeadAndHandThatBothCamerasSeeAreWithinThreeMillimetres) {
  std::vector<double> off_mm;
  for (const Step& step : steps_) {  // the side camera looks 8 ms after the front one
    if (step.body.trouble != tracking::TrackingTrouble::kNone || step.seen.camera != "side")
      continue;
    if (step.seen.body != "head" && step.seen.body != "hand") continue;
    off_mm.push_back(1e3 * (step.body.raw.position_m - step.truth.position_m).norm());
  }
  ASSERT_GT(off_mm.size(), 850u);
  std::ranges::sort(off_mm);
  const auto at = [&](double share) {
    return off_mm[static_cast<std::size_t>(share * static_cast<double>(off_mm.size()))];
  };
  std::printf("both cameras: median %.2f mm, 95 %% %.2f mm, worst %.1f mm of %zu\n", at(0.5),
              at(0.95), off_mm.back(), off_mm.size());
  EXPECT_LT(at(0.5), 1.0);
  EXPECT_LT(at(0.95), 3.0);
}

TEST_F(MaintenanceTracking, AWrongMarkerAmongMoreThanSixIsLeftOutElseThereIsNoPose) {
  // 45 px beside a pixel of noise: seen from the true pose.
  int left_out = 0, without_pose = 0;
  for (const Step& step : steps_) {
    if (is_within(step, 25.0, 26.2) || is_within(step, 22.1, 22.13)) continue;
    const auto camera =
        std::ranges::find(setup_.cameras, step.seen.camera, &tracking::TrackingCamera::name);
    const auto body = std::ranges::find(setup_.bodies, step.seen.body, &tracking::MarkerBody::name);
    const pose::Pose in_tracker = drive(bind(setup_.registration, pose::Pose{}), step.truth);
    const pose::Pose in_camera = drive(bind(*camera->pose, pose::Pose{}), in_tracker);
    bool spoiled = false;
    for (const tracking::SeenMarker& point : step.seen.points) {
      const Vector3d x = to_world(in_camera, body->markers[point.id].position_m);
      const Eigen::Vector2d p_px(camera->lens.fx_px * x.x() / x.z() + camera->lens.cx_px,
                                 camera->lens.fy_px * x.y() / x.z() + camera->lens.cy_px);
      spoiled = spoiled || (p_px - point.pixel_px).norm() > 20.0;
    }
    if (!spoiled) continue;
    const bool may_choose = step.seen.points.size() > 6;
    EXPECT_EQ(step.body.trouble,
              may_choose ? tracking::TrackingTrouble::kNone : tracking::TrackingTrouble::kNoPose)
        << step.seen.body << " at " << step.seen.time_s;
    ++(may_choose ? left_out : without_pose);
  }
  EXPECT_GT(left_out, 10);
  EXPECT_GT(without_pose, 2);
  EXPECT_LT(left_out + without_pose, 40);
}

TEST_F(MaintenanceTracking, EachTrackingFaultIsReportedAtItsTime) {
  EXPECT_EQ(troubles("hand", tracking::TrackingTrouble::kTooFewPoints, 18.0, 18.4), 12);
  EXPECT_EQ(troubles("head", tracking::TrackingTrouble::kJump, 22.1, 22.13), 1);
  EXPECT_EQ(troubles("head", tracking::TrackingTrouble::kJump, 0.0, 30.0), 1);
  EXPECT_EQ(troubles("shoulder", tracking::TrackingTrouble::kOutOfOrder, 14.0, 14.3), 1);
  EXPECT_EQ(troubles("shoulder", tracking::TrackingTrouble::kOutOfOrder, 0.0, 30.0), 1);
  EXPECT_GT(troubles("shoulder", tracking::TrackingTrouble::kFrozen, 25.5, 26.2), 8);
  EXPECT_EQ(troubles("shoulder", tracking::TrackingTrouble::kFrozen, 0.0, 25.5), 0);
  for (const Step* step : of("waist")) EXPECT_FALSE(is_within(*step, 9.0, 10.2));
  for (const tracking::TrackingTrouble never :
       {tracking::TrackingTrouble::kInvalid, tracking::TrackingTrouble::kDegenerate}) {
    for (const Step& step : steps_) EXPECT_NE(step.body.trouble, never);
  }
}

TEST_F(MaintenanceTracking, TheWaistIsLostBehindTheTableAndComesBack) {
  tracking::OperatorTracker tracker(setup_);
  std::map<tracking::BodyState, int> before, while_hidden, after;
  for (const Step& step : steps_) {
    ASSERT_EQ(message_of(tracker.take(step.seen, step.seen.time_s)), "");
    const tracking::BodyState state =
        tracker.at(step.seen.time_s)[tracking::BodyRole::kWaist].state;
    if (is_within(step, 1.0, 9.0)) ++before[state];
    if (is_within(step, 9.7, 10.2)) ++while_hidden[state];
    if (is_within(step, 10.4, 30.0)) ++after[state];
  }
  EXPECT_EQ(before.count(tracking::BodyState::kLost), 0u);
  EXPECT_EQ(while_hidden.size(), 1u);
  EXPECT_GT(while_hidden[tracking::BodyState::kLost], 10);
  EXPECT_GT(after[tracking::BodyState::kTracked], 1000);
  EXPECT_EQ(after.count(tracking::BodyState::kLost), 0u);
}

}  // namespace tact::host::maintenance_tracking_test
