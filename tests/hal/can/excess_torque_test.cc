// SPDX-License-Identifier: Apache-2.0
// A drive that follows its commands late, or gives less, is good; one that gives more is found.
#include "hal/can/excess_torque.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

namespace tact::hal::can::excess_torque_test {

constexpr double kMax_Nm = 0.5, kLimit_Nm = kMaxExcess_ratio * kMax_Nm;

/// Random commands, and a drive that is up to two samples late and gives a share of them.
class RandomDrive {
 public:
  explicit RandomDrive(unsigned seed) : random_(seed) {}

  double command_Nm() {
    before_[1] = before_[0], before_[0] = now_;
    const bool jumps = std::bernoulli_distribution(0.2)(random_);
    if (jumps) now_ = std::uniform_real_distribution(-kMax_Nm, kMax_Nm)(random_);
    return now_;
  }
  double measured_Nm() {
    const double share = std::uniform_real_distribution(0.0, 1.0)(random_);
    const std::array<double, 3> last{now_, before_[0], before_[1]};
    return share * last[std::uniform_int_distribution<std::size_t>(0, 2)(random_)];
  }

 private:
  std::mt19937 random_;
  double now_ = 0.0;
  std::array<double, 2> before_{};
};

TEST(ExcessTorque, DelayedOrReducedTorqueHasNoExcess) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomDrive drive(seed);
    ExcessTorque excess;
    for (int i = 0; i < 1000; ++i) {
      excess.command(drive.command_Nm());
      excess.measure(drive.measured_Nm(), true);
      ASSERT_EQ(excess.mean_Nm(), 0.0) << "seed " << seed << ", sample " << i;
    }
  }
}

TEST(ExcessTorque, TwiceTheLimitLatchesWithin50Samples) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomDrive drive(seed);
    ExcessTorque excess;
    const double extra_Nm = (seed % 2 == 0 ? 1.0 : -1.0) * (kMax_Nm + 2.0 * kLimit_Nm);
    for (int i = 0; i < 50; ++i) {
      excess.command(drive.command_Nm());
      excess.measure(extra_Nm, true);
    }
    EXPECT_TRUE(excess.exceeds(kLimit_Nm)) << "seed " << seed;
  }
}

TEST(ExcessTorque, MeanRestartsWithPowerAndNanExceedsTheLimit) {
  ExcessTorque excess;
  for (int i = 0; i < 100; ++i) excess.measure(kMax_Nm, true);
  EXPECT_TRUE(excess.exceeds(kLimit_Nm));
  excess.measure(kMax_Nm, false);
  EXPECT_FALSE(excess.exceeds(kLimit_Nm));
  excess.measure(std::numeric_limits<double>::quiet_NaN(), true);
  EXPECT_TRUE(excess.exceeds(kLimit_Nm));
}

}  // namespace tact::hal::can::excess_torque_test
