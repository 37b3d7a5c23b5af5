// SPDX-License-Identifier: Apache-2.0
// The tracked operator of the scene maintenance: what the shipped recording must be, and that the
// tracker finds in it what was put in. tact-make-tracking tells the true poses.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "host/tracking/observation.h"
#include "host/tracking/operator_tracker.h"
#include "host/tracking/tracking_setup.h"
#include "tests/support/mesh_files.h"
#include "tests/support/sentence.h"

namespace tact::host::make_tracking_test {

using tests::sentence_of;

using Eigen::Quaterniond;
using Eigen::Vector3d;
using tests::read_text;
using tests::TempDirectory;

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";
const std::string kObservations = "maintenance.observations.jsonl";
const std::string kDescription = "maintenance.tracking.toml";

/// A look of the recording, what the tracker made of it, and what was true.
struct Step {
  tracking::Observation seen;
  std::size_t bytes = 0;
  pose::Pose truth{};
  tracking::TrackedBody body{};  // just after it
};

class MaintenanceTracking : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TempDirectory temp;
    const tests::Ran ran =
        tests::run_apart(temp, "tact-make-tracking", "--truth --out " + temp.path());
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const std::string& name : {kObservations, kDescription})
      same_bytes_ = same_bytes_ && read_text(temp.path() + "/" + name) == read_text(kScenes + name);
    const auto setup = tracking::load_tracking_setup(kScenes + kDescription);
    ASSERT_EQ(sentence_of(setup), "");
    setup_ = *setup;
    std::istringstream lines(read_text(kScenes + kObservations));
    std::istringstream truths(read_text(temp.path() + "/maintenance.truth.jsonl"));
    std::string line, truth;
    tracking::OperatorTracker tracker(setup_);
    while (std::getline(lines, line)) {
      Step step;
      step.bytes = line.size();
      const auto seen = tracking::parse_observation(line);
      ASSERT_EQ(sentence_of(seen), "") << line;
      step.seen = *seen;
      ASSERT_TRUE(std::getline(truths, truth));
      step.truth = true_pose(truth, step.seen);
      ASSERT_EQ(sentence_of(tracker.take(step.seen, step.seen.time_s)), "") << line;
      step.body = tracker.at(step.seen.time_s)[role_of(step.seen.body)];
      steps_.push_back(step);
    }
    EXPECT_FALSE(std::getline(truths, truth));
  }

  static pose::Pose true_pose(const std::string& line, const tracking::Observation& seen) {
    const auto truth = nlohmann::json::parse(line);
    EXPECT_EQ(truth["body"], seen.body);
    EXPECT_EQ(truth["time_s"], seen.time_s);
    const auto p = truth["position_m"].get<std::array<double, 3>>();
    const auto q = truth["rotation_wxyz"].get<std::array<double, 4>>();
    return {.rotation = Quaterniond(q[0], q[1], q[2], q[3]), .position_m = {p[0], p[1], p[2]}};
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
  inline static bool same_bytes_ = true;
};

TEST_F(MaintenanceTracking, TheGeneratorGivesTheShippedFilesByteForByte) {
  EXPECT_TRUE(same_bytes_);
}

TEST_F(MaintenanceTracking, LastsThirtySecondsAtThirtyLooksASecondInLessThan600kB) {
  EXPECT_NEAR(steps_.front().seen.time_s, 0.0, 1.0 / 30.0);
  EXPECT_NEAR(steps_.back().seen.time_s, 30.0 - 1.0 / 30.0, 1e-3);
  EXPECT_EQ(of("head").size(), 900u);
  EXPECT_EQ(of("hand").size(), 900u);
  EXPECT_EQ(of("shoulder").size(), 450u);
  std::size_t bytes = 0;
  for (const Step& step : steps_) bytes += step.bytes + 1;
  EXPECT_LT(bytes, 600'000u);
  std::set<std::string> cameras;
  for (const Step& step : steps_) cameras.insert(step.seen.camera);
  EXPECT_EQ(cameras, (std::set<std::string>{"front", "side"}));
}

TEST_F(MaintenanceTracking, ItsMarkersFillTheirBodiesAndThePicture) {
  for (const tracking::MarkerBody& body : setup_.bodies) {
    EXPECT_EQ(body.markers.size(), 8u);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const tracking::BodyMarker& m : body.markers)
      spread += m.position_m * m.position_m.transpose() / 8.0;
    const Vector3d size_m = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
    EXPECT_GT(std::sqrt(size_m.x()), 0.03) << body.name << ": not in a plane";
  }
  for (const Step& step : steps_) {
    for (const tracking::SeenMarker& point : step.seen.points) {
      EXPECT_GT(point.pixel_px.minCoeff(), 0.0);
      EXPECT_LT(point.pixel_px.x(), 1920.0);
      EXPECT_LT(point.pixel_px.y(), 1080.0);
    }
  }
}

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

TEST_F(MaintenanceTracking, TellsWhatWentWrongAndWhen) {
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

TEST_F(MaintenanceTracking, TheMotionIsOneOfAPersonAndBeginsWhereItEnds) {
  for (const std::string body : {"head", "shoulder", "waist", "hand"}) {
    const auto steps = of(body);
    double path_m = 0.0;
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const double s = std::abs(steps[i]->seen.time_s - steps[i - 1]->seen.time_s);
      const double way_m = (steps[i]->truth.position_m - steps[i - 1]->truth.position_m).norm();
      EXPECT_LT(way_m, 1.0 * s) << body << " at " << steps[i]->seen.time_s;
      path_m += way_m;
    }
    EXPECT_GT(path_m, 0.2) << body;
    const Vector3d gap_m = steps.front()->truth.position_m - steps.back()->truth.position_m;
    EXPECT_LT(gap_m.norm(), 0.005) << body << ": the next round goes on without a jump";
  }
}

TEST_F(MaintenanceTracking, TheWaistIsLostBehindTheTableAndComesBack) {
  tracking::OperatorTracker tracker(setup_);
  std::map<tracking::BodyState, int> before, while_hidden, after;
  for (const Step& step : steps_) {
    ASSERT_EQ(sentence_of(tracker.take(step.seen, step.seen.time_s)), "");
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

TEST_F(MaintenanceTracking, RefusesBadUsageInOneLine) {
  const TempDirectory temp;
  for (const std::string arguments : {"", "--out /nowhere/at/all", "--out . --fast"}) {
    const tests::Ran ran = tests::run_apart(temp, "tact-make-tracking", arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.rfind("tact-make-tracking: ", 0), 0u) << ran.err;
  }
}

}  // namespace tact::host::make_tracking_test
