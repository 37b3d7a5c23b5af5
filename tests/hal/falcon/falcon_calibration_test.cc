// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hal/falcon/falcon_kinematics.h"

namespace tact::hal::falcon::falcon_calibration_test {

constexpr double kGain[3] = {7600.0, 8400.0, 9100.0};
constexpr double kDead[3] = {60.0, 90.0, 120.0};
constexpr double kMoving_kg = 0.087;

std::vector<FalconBalance> balances(const std::vector<Vec3>& poses_W,
                                    const std::vector<double>& masses_kg,
                                    double noise_words = 0.0) {
  const FalconKinematics falcon;
  std::vector<FalconBalance> out;
  unsigned random = 12345;
  for (const Vec3& p_W : poses_W) {
    for (const double mass_kg : masses_kg) {
      FalconBalance b{.position_m = falcon_point_D(p_W), .mass_kg = mass_kg};
      const model::Mat3 k = falcon.joint_rate_matrix(falcon.inverse(b.position_m));
      // Up is y of the device; K^T t = F, written out.
      const Vec3 torque_Nm =
          model::inverse(model::transpose(k)) * Vec3{0.0, 9.81 * (mass_kg + kMoving_kg), 0.0};
      const double t[3] = {torque_Nm.x, torque_Nm.y, torque_Nm.z};
      for (std::size_t i = 0; i < 3; ++i) {
        random = random * 1664525u + 1013904223u;
        const double noise = noise_words * (static_cast<double>(random >> 8) / 8388608.0 - 1.0);
        b.words[i] = -(kGain[i] * t[i] + std::copysign(kDead[i], t[i])) + noise;
      }
      out.push_back(b);
    }
  }
  return out;
}

const std::vector<Vec3> kPoses_W{{0.0, 0.0, -0.02}, {0.02, 0.0, -0.02}, {-0.02, 0.01, 0.01}};
const std::vector<double> kMasses_kg{0.05, 0.1, 0.2, 0.3};

TEST(FalconCalibration, FindsGainsDeadBandsAndTheMovingMass) {
  const auto samples = balances(kPoses_W, kMasses_kg);
  const auto fit = fit_falcon(samples);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->gain_words_per_Nm[0], kGain[0], 1.0);
  EXPECT_NEAR(fit->gain_words_per_Nm[1], kGain[1], 1.0);
  EXPECT_NEAR(fit->gain_words_per_Nm[2], kGain[2], 1.0);
  EXPECT_NEAR(fit->dead_band_words[0], kDead[0], 0.1);
  EXPECT_NEAR(fit->dead_band_words[1], kDead[1], 0.1);
  EXPECT_NEAR(fit->dead_band_words[2], kDead[2], 0.1);
  EXPECT_NEAR(fit->moving_mass_kg, kMoving_kg, 1e-5);
  EXPECT_LT(fit->residual_words, 0.01);
}

TEST(FalconCalibration, BearsNoiseOfAFewWords) {
  const auto fit = fit_falcon(balances(kPoses_W, kMasses_kg, 8.0));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->gain_words_per_Nm[0], kGain[0], 0.05 * kGain[0]);
  EXPECT_NEAR(fit->gain_words_per_Nm[1], kGain[1], 0.05 * kGain[1]);
  EXPECT_NEAR(fit->gain_words_per_Nm[2], kGain[2], 0.05 * kGain[2]);
  EXPECT_GT(fit->residual_words, 1.0);
  EXPECT_LT(fit->residual_words, 8.0);
}

TEST(FalconCalibration, OnePoseCannotSeparateDeadBandFromMovingMass) {
  const auto fit = fit_falcon(balances({kPoses_W[0]}, kMasses_kg));
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("other poses"), std::string::npos);
}

TEST(FalconCalibration, OneMassIsNotEnough) {
  const auto fit = fit_falcon(balances(kPoses_W, {0.1, 0.1}));
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("masses"), std::string::npos);
  EXPECT_FALSE(fit_falcon({}));
}

TEST(FalconCalibration, WordsThatDoNotFollowTheLoadAreRefused) {
  auto samples = balances(kPoses_W, kMasses_kg);
  for (FalconBalance& s : samples) s.words[1] = -s.words[1];
  const auto fit = fit_falcon(samples);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("axis 2"), std::string::npos) << fit.error().message;
  samples[2].words[0] = std::nan("");
  EXPECT_FALSE(fit_falcon(samples));
}

TEST(FalconCalibration, TheLinesAreThoseOfAScene) {
  const std::string lines = scene_lines({.gain_words_per_Nm = {7600.4, 8400.0, 9100.0},
                                         .dead_band_words = {60.0, 90.0, 119.6},
                                         .moving_mass_kg = 0.0871,
                                         .residual_words = 0.0});
  EXPECT_EQ(lines,
            "[device.falcon]\ngain_words_per_Nm = [7600.0, 8400.0, 9100.0]\n"
            "dead_band_words = [60.0, 90.0, 120.0]\nmoving_mass_kg = 0.087\n");
}

}  // namespace tact::hal::falcon::falcon_calibration_test
