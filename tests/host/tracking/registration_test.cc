// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/registration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "host/tracking/tracking_setup.h"
#include "tests/support/message.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::registration_test {

using tests::message_of;

using Eigen::Vector3d;

const Pose kTable{.rotation = test::turn(2.1, {0.3, -1.0, 0.4}), .position_m = {-0.7, 0.5, 1.3}};

/// Poses all over a workspace of 10 cm, with Gaussian noise on what the tracker says.
std::vector<PosePair> poses(std::size_t count, double noise_m, bool flat = false,
                            unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-0.05, 0.05);
  std::normal_distribution<double> normal;
  std::vector<PosePair> out;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d p(side(random), side(random), flat ? 0.0 : side(random));
    const Vector3d off(normal(random), normal(random), normal(random));
    // kTable maps the tracker's frame to the device's: q = R^T (p - t)
    const Vector3d q = kTable.rotation.conjugate() * (p - kTable.position_m) + noise_m * off;
    out.push_back({.tracked_m = q, .device_m = p});
  }
  return out;
}

TEST(Registration, IsExactWithoutNoise) {
  for (const std::size_t count : {6u, 12u, 50u}) {
    for (const bool flat : {false, true}) {
      const model::Result<Registration> got = fit_registration(poses(count, 0.0, flat));
      ASSERT_EQ(message_of(got), "");
      EXPECT_LT(got->transform.rotation.angularDistance(kTable.rotation), 1e-7);
      EXPECT_LT((got->transform.position_m - kTable.position_m).norm(), 1e-9);
      EXPECT_LT(got->largest_m, 1e-9);
      EXPECT_EQ(got->residual_m.size(), count);
    }
  }
}

TEST(Registration, LeavesAsMuchResidualAsTheNoiseHas) {
  // 3 n numbers, 6 of them spent on the motion: E[n rms^2] = (3 n - 6) sigma^2.
  const double sigma_m = 0.001;
  const std::size_t count = 12;
  double sum_m2 = 0.0;
  const unsigned trials = 200;
  for (unsigned seed = 0; seed < trials; ++seed) {
    const model::Result<Registration> got = fit_registration(poses(count, sigma_m, false, seed));
    ASSERT_EQ(message_of(got), "");
    sum_m2 += count * got->rms_m * got->rms_m / (3.0 * count - 6.0);
    EXPECT_GE(got->largest_m, got->rms_m);
  }
  EXPECT_NEAR(sum_m2 / trials / (sigma_m * sigma_m), 1.0, 0.08);
}

TEST(Registration, APoseThatIsWrongHasTheLargestResidual) {
  std::vector<PosePair> all = poses(12, 0.0002);
  all[7].tracked_m += Vector3d(0.01, 0.0, 0.0);
  const model::Result<Registration> got = fit_registration(all);
  ASSERT_EQ(message_of(got), "");
  EXPECT_EQ(std::ranges::max_element(got->residual_m) - got->residual_m.begin(), 7);
  EXPECT_GT(got->largest_m, kDoubtful_m);
}

TEST(Registration, TwoMillimetresAreDoubtful) {
  // One pose of twelve is off: most of it stays with that pose, a little goes into the fit.
  const auto largest_m = [](double off_m) {
    std::vector<PosePair> all = poses(12, 0.0);
    all[7].tracked_m += Vector3d(off_m, 0.0, 0.0);
    const model::Result<Registration> got = fit_registration(all);
    EXPECT_EQ(message_of(got), "");
    return got ? got->largest_m : 0.0;
  };
  const double share = largest_m(0.001) / 0.001;
  const double fine_m = largest_m(0.0018 / share), doubtful_m = largest_m(0.0022 / share);
  EXPECT_NEAR(fine_m, 0.0018, 2e-5);
  EXPECT_NEAR(doubtful_m, 0.0022, 2e-5);
  EXPECT_LE(fine_m, kDoubtful_m);
  EXPECT_GT(doubtful_m, kDoubtful_m);
}

TEST(Registration, NeverMirrors) {
  std::vector<PosePair> all = poses(8, 0.0);
  for (PosePair& pose : all) pose.tracked_m.x() *= -1.0;  // a left-handed tracker
  const model::Result<Registration> got = fit_registration(all);
  ASSERT_EQ(message_of(got), "");
  EXPECT_NEAR(got->transform.rotation.norm(), 1.0, 1e-12);
  EXPECT_GT(got->rms_m, 0.01);  // and it shows
}

TEST(Registration, TooFewCollinearOrNanPosesAreRefused) {
  EXPECT_NE(message_of(fit_registration(poses(5, 0.0))).find("5 poses are too few"),
            std::string::npos);
  EXPECT_NE(message_of(fit_registration({})).find("too few"), std::string::npos);
  std::vector<PosePair> line = poses(8, 0.0);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double s_m = 0.02 * static_cast<double>(i);
    line[i] = {.tracked_m = {s_m, 2.0 * s_m, 1.0}, .device_m = {s_m, 0.0, 2.0 * s_m}};
  }
  EXPECT_NE(message_of(fit_registration(line)).find("line"), std::string::npos);
  std::vector<PosePair> almost = line;  // 1 mm of a hand that trembles is no direction
  for (std::size_t i = 0; i < almost.size(); ++i) almost[i].tracked_m.z() += i % 2 ? 1e-3 : 0.0;
  EXPECT_NE(message_of(fit_registration(almost)).find("line"), std::string::npos);
  std::vector<PosePair> one_side = poses(8, 0.0);  // the device moves, the tracker sees a line
  for (std::size_t i = 0; i < 8; ++i) one_side[i].tracked_m = line[i].tracked_m;
  EXPECT_NE(message_of(fit_registration(one_side)).find("line"), std::string::npos);
  std::vector<PosePair> spot(8);
  EXPECT_NE(message_of(fit_registration(spot)).find("one place"), std::string::npos);
  std::vector<PosePair> broken = poses(8, 0.0);
  broken[3].device_m.y() = std::nan("");
  EXPECT_NE(message_of(fit_registration(broken)).find("not finite"), std::string::npos);
}

/// Telemetry at 60 frames/s, a tracker at 30 looks/s unless a test says otherwise.
class Collector : public ::testing::Test {
 protected:
  /// A visit of `seconds` at `device_m`; the number of poses taken.
  int visit(const Vector3d& device_m, double seconds, double speed_mps = 0.0, bool seen = true) {
    int taken = 0;
    for (const double end_s = now_s + seconds; now_s < end_s; now_s += 1.0 / 60.0) {
      if (frames++ % frames_per_look == 0) look_m = see(device_m);
      const auto tip_m = seen ? std::optional(look_m) : std::nullopt;
      taken += collector.add(now_s, device_m, speed_mps, tip_m) ? 1 : 0;
    }
    return taken;
  }
  int visit(double x_m, double seconds, double speed_mps = 0.0, bool seen = true) {
    return visit(Vector3d(x_m, 0.0, 0.0), seconds, speed_mps, seen);
  }
  /// One camera, which looks along kTable's y: 3 mm of noise in depth, a tenth of it across.
  Vector3d see(const Vector3d& device_m) {
    const Vector3d off_m(3e-4 * normal(random), 3e-3 * normal(random), 3e-4 * normal(random));
    return kTable.rotation.conjugate() * (device_m - kTable.position_m) + off_m;
  }

  PoseCollector collector;
  std::mt19937 random{3};
  std::normal_distribution<double> normal;
  double now_s = 0.0;
  int frames = 0, frames_per_look = 2;
  Vector3d look_m = Vector3d::Zero();
};

TEST_F(Collector, TakesOnePoseForEachRestOfTheTool) {
  EXPECT_EQ(visit(0.00, 1.2), 0);  // not long enough
  EXPECT_EQ(visit(0.01, 0.1, 0.05), 0);
  EXPECT_EQ(visit(0.02, 5.0), 1);  // once
  EXPECT_EQ(visit(0.03, 0.1, 0.05), 0);
  EXPECT_EQ(visit(0.034, 5.0), 0);  // 14 mm from the first
  EXPECT_EQ(visit(0.05, 0.1, 0.05), 0);
  EXPECT_EQ(visit(0.036, 5.0), 1);  // 16 mm
  ASSERT_EQ(collector.poses().size(), 2u);
  EXPECT_NEAR(collector.poses()[0].device_m.x(), 0.02, 1e-12);
}

TEST_F(Collector, TheNoiseOfOneCameraIsAveragedBelowTheWarning) {
  int warned = 0;
  for (int trial = 0; trial < 100; ++trial) {
    collector = {};
    for (int place = 0; place < 12; ++place) {
      const Vector3d p(0.04 * (place % 3), 0.04 * (place / 3 % 2), 0.04 * (place / 6));
      visit(p, 0.1, 0.05);
      ASSERT_EQ(visit(p, 2.5), 1);
    }
    const model::Result<Registration> got = fit_registration(collector.poses());
    ASSERT_EQ(message_of(got), "");
    warned += got->largest_m > kDoubtful_m ? 1 : 0;
  }
  EXPECT_LE(warned, 1);
}

TEST_F(Collector, ALookThatIsRepeatedCountsOnce) {
  frames_per_look = 6;            // 10 looks/s
  EXPECT_EQ(visit(0.0, 3.8), 0);  // 228 frames, 38 looks at most
  EXPECT_EQ(visit(0.0, 0.7), 1);  // 0.2 s of settling and 40 looks
  frames_per_look = 1'000'000;    // the tracker says one thing for ever
  EXPECT_EQ(visit(0.1, 0.1, 0.05), 0);
  EXPECT_EQ(visit(0.1, 20.0), 0);
}

TEST_F(Collector, AToolThatCreepsIsNotStandingStill) {
  for (int i = 0; i < 3600; ++i) EXPECT_EQ(visit(4e-3 * now_s, 1e-3, 4e-3), 0) << i;  // one minute
}

TEST_F(Collector, AfterAPoseTheMeanBeginsAgain) {
  // Within the millimetre the tool goes on; far from the first place it is taken where it is then.
  ASSERT_EQ(visit(0.0, 30.0), 1);
  ASSERT_EQ(visit(0.0158, 2.5), 1);  // without a rest between them
  EXPECT_NEAR(collector.poses()[1].device_m.x(), 0.0158, 1e-9);
  // 14.6 mm from the second it is not new, however long; 15.4 mm is, though no millimetre farther.
  ASSERT_EQ(visit(0.0304, 30.0), 0);
  ASSERT_EQ(visit(0.0312, 5.0), 1);
  EXPECT_NEAR(collector.poses()[2].device_m.x(), 0.0312, 5e-4);
}

TEST_F(Collector, MovingOrUnseenToolGivesNoPose) {
  EXPECT_EQ(visit(0.0, 5.0, PoseCollector::kStill_mps), 0);
  EXPECT_EQ(visit(0.0, 5.0, std::nan("")), 0);
  EXPECT_EQ(visit(0.0, 5.0, 0.0, false), 0);
}

TEST(RegistrationFile, IsReadBackAndTheOldOneIsKept) {
  const std::string folder = "/tmp/tact-registration-" + std::to_string(getpid());
  std::filesystem::create_directory(folder);
  const std::string tracking = folder + "/desk.tracking.toml", path = registration_path(tracking);
  EXPECT_EQ(path, folder + "/desk.registration.toml");
  test::write_file(tracking, test::description("udp_port = 8322", {{"h", "hand"}}));
  model::Result<TrackingSetup> setup = load_tracking_setup(tracking);
  ASSERT_EQ(message_of(setup), "");
  EXPECT_EQ(setup->registered_by, "");

  const model::Result<Registration> got = fit_registration(poses(9, 0.0));
  ASSERT_EQ(message_of(got), "");
  ASSERT_EQ(message_of(write_registration(path, *got)), "");
  EXPECT_FALSE(std::filesystem::exists(path + ".bak"));
  setup = load_tracking_setup(tracking);
  ASSERT_EQ(message_of(setup), "");
  EXPECT_EQ(setup->registered_by, path);
  EXPECT_LT(setup->registration.rotation.angularDistance(kTable.rotation), 1e-9);
  EXPECT_LT((setup->registration.position_m - kTable.position_m).norm(), 1e-8);

  Registration other = *got;
  other.transform.position_m = Vector3d::Zero();
  ASSERT_EQ(message_of(write_registration(path, other)), "");
  EXPECT_TRUE(std::filesystem::exists(path + ".bak"));
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
  setup = load_tracking_setup(tracking);
  ASSERT_EQ(message_of(setup), "");
  EXPECT_EQ(setup->registration.position_m, Vector3d::Zero());
  EXPECT_TRUE(write_registration(folder + "/none/x.toml", *got));
  std::filesystem::remove_all(folder);
}

}  // namespace tact::host::tracking::registration_test
