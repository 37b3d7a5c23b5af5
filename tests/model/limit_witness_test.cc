// SPDX-License-Identifier: Apache-2.0
// The witness sees each limit broken, and none that was kept; its sums are those of pen and paper.
#include "model/limit_witness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace tact::model::limit_witness_test {

constexpr Limits kLimits{.force_N = 8.0,
                         .torque_Nm = 0.2,
                         .slew_N_per_s = 1000.0,
                         .ramp_s = 0.1,
                         .speed_mps = 1.0,
                         .turn_radps = 10.0,
                         .energy_J = 0.01,
                         .recovery_W = 0.0,
                         .continuous_force_N = 4.0,
                         .thermal_time_s = 0.5,
                         .power_W = 6.0,
                         .grip_force_N = 2.0};

class Witness : public testing::Test {
 protected:
  /// The first limit that so many ticks broke; empty: none.
  std::string after(int ticks, const std::function<void(WrittenTick&, int)>& change) {
    for (int i = 0; i < ticks; ++i) {
      tick.skipped_periods = 0;
      change(tick, i);
      if (const char* broken = witness.check(tick)) return broken;
    }
    return {};
  }
  std::string raise_to(double force_N) {
    return after(static_cast<int>(std::ceil(force_N)),
                 [&](WrittenTick& t, int i) { t.written.force_N.x = std::fmin(i + 1, force_N); });
  }
  std::string once(const std::function<void(WrittenTick&)>& change) {
    return after(1, [&](WrittenTick& t, int) { change(t); });
  }
  void turn_to(double angle_rad) {
    tick.tool.orientation = {std::cos(0.5 * angle_rad), 0.0, std::sin(0.5 * angle_rad), 0.0};
  }

  LimitWitness witness{kLimits, 0.001};
  WrittenTick tick{.fresh = true, .armed = true};
};

TEST_F(Witness, SumsAreThoseOfPenAndPaper) {
  raise_to(2.0);
  tick.written.torque_Nm = {0.0, 0.02, 0.0};
  once([](WrittenTick&) {});
  tick.tool.position_m.x = 0.001;
  turn_to(0.01);
  EXPECT_EQ(once([](WrittenTick&) {}), "");
  EXPECT_NEAR(witness.total_given_energy_J(), 2.0 * 0.001 + 0.02 * 2.0 * std::sin(0.005), 1e-15);
  tick.fresh = false;  // 1 ms without a sample, and then the way of both: the mean force counts
  once([](WrittenTick& t) { t.written.force_N.x = 1.0; });
  tick.fresh = true;
  tick.tool.position_m.x = 0.003;
  once([](WrittenTick&) {});
  EXPECT_NEAR(witness.total_given_energy_J(), 0.002 + 0.02 * 2.0 * std::sin(0.005) + 1.5 * 0.002,
              1e-15);
  EXPECT_TRUE(witness.is_motion_permitted());
  EXPECT_DOUBLE_EQ(witness.worst().force_N, 2.0);
  EXPECT_DOUBLE_EQ(witness.worst().step_N, 1.0);
}

TEST_F(Witness, SeesAPeakOfForceTorqueFingersAndPower) {
  EXPECT_EQ(raise_to(8.0), "");
  EXPECT_EQ(once([](WrittenTick& t) { t.written.force_N.x = 8.0 + 1e-12; }), "|F| <= force_N");
  tick.written = {};
  EXPECT_EQ(once([](WrittenTick& t) { t.written.torque_Nm.y = 0.2 + 1e-12; }), "|T| <= torque_Nm");
  tick.written = {};
  EXPECT_EQ(once([](WrittenTick& t) { t.written_grip_N = -2.1; }), "grip <= grip_force_N");
  tick.written_grip_N = 0.0;
  raise_to(3.0);
  tick.tool.velocity_mps.x = 1.0;
  EXPECT_EQ(once([](WrittenTick&) {}), "");
  tick.tool.angular_velocity_radps.y = 301.0;
  tick.written.torque_Nm.y = 0.01;
  EXPECT_EQ(once([](WrittenTick&) {}), "F . v + T . w <= power_W");
  EXPECT_EQ(once([](WrittenTick& t) { t.written.force_N.x = std::nan(""); }),
            "what is written is finite");
}

TEST_F(Witness, SeesAForceWithoutArmingAndBehindAFault) {
  for (const bool faulted : {false, true}) {
    raise_to(1.0);
    tick.armed = faulted;
    tick.faulted = faulted;
    EXPECT_EQ(once([](WrittenTick&) {}), "zero unless armed and without a fault");
    EXPECT_EQ(once([](WrittenTick& t) { t.written = {}; }), "");
    tick.armed = true, tick.faulted = false;
  }
}

TEST_F(Witness, SeesAStepThatIsTooLongForItsTime) {
  EXPECT_EQ(once([](WrittenTick& t) { t.written.force_N.x = 1.0 + 1e-9; }),
            "|dF| <= slew_N_per_s dt");
  raise_to(5.0);
  const auto fall = [](double force_N, double torque_Nm) {
    return [=](WrittenTick& t) {
      t.written = {{force_N, 0.0, 0.0}, {torque_Nm, 0.0, 0.0}};
      t.skipped_periods = 2;
    };
  };
  EXPECT_EQ(once(fall(2.0, 0.025)), "") << "three periods: 3 N, and torque grows by one";
  EXPECT_EQ(once(fall(2.0, 0.075)), "a late force grows by one period's slew");
  EXPECT_EQ(once(fall(2.0, -0.01)), "|dT| <= slew_N_per_s dt torque_Nm / force_N");
}

TEST_F(Witness, SeesMotorsThatGetTooWarm) {
  raise_to(8.0);
  EXPECT_EQ(after(1000, [](WrittenTick&, int) {}), "RMS <= continuous_force_N");
  LimitWitness late(kLimits, 0.001);
  witness = late;
  tick.written = {};
  raise_to(8.0);
  once([](WrittenTick& t) { t.skipped_periods = 10; });
  const std::string broken = after(1000, [](WrittenTick&, int) {});
  EXPECT_TRUE(broken.starts_with("RMS^2 <= continuous^2")) << broken;
  EXPECT_GT(witness.rms_ratio(), 1.0);
  witness = late;
  tick.written = {};
  const std::string torque = after(
      1000, [](WrittenTick& t, int i) { t.written.torque_Nm.z = std::fmin(0.2, 0.025 * (i + 1)); });
  EXPECT_EQ(torque, "RMS of T <= continuous_force_N torque_Nm / force_N");
}

TEST_F(Witness, SeesEnergyBeyondTheBudget) {
  raise_to(5.0);
  const auto flee = [](double step_m) {
    return [=](WrittenTick& t, int) { t.tool.position_m.x += step_m; };
  };
  EXPECT_EQ(after(10, flee(0.0009)).substr(0, 12), "energy given");
  EXPECT_GT(witness.total_given_energy_J(), 0.01);
  tick.faulted = true;  // of the force that the fault has ended
  EXPECT_EQ(once([](WrittenTick& t) { t.written = {}; }),
            "energy given <= energy_J + recovery_W t");
  tick.faulted = tick.armed = false;
  once([](WrittenTick&) {});
  tick.armed = true;
  EXPECT_EQ(once([](WrittenTick&) {}), "") << "armed again: from the beginning";
  raise_to(5.0);
  EXPECT_EQ(once([](WrittenTick& t) { t.tool.position_m.x += 0.1; }),
            "energy given: beyond the budget it stops in the same tick");
  EXPECT_FALSE(witness.is_motion_permitted()) << "100 m/s";
}

TEST_F(Witness, SeesEnergyThatWasTakenBeforeGivenAtOnce) {
  raise_to(5.0);
  const auto move = [](double step_m) {
    return [=](WrittenTick& t, int) { t.tool.position_m.x += step_m; };
  };
  EXPECT_EQ(after(20, move(-0.0009)), "");
  EXPECT_EQ(after(4, move(0.0009)), "");
  EXPECT_EQ(after(1, move(0.0009)), "energy given in any t <= 2 energy_J + recovery_W t");
}

TEST_F(Witness, SeesAForceThatStaysWithoutSamples) {
  raise_to(1.0);
  tick.fresh = false;
  EXPECT_EQ(after(10, [](WrittenTick&, int) {}), "");
  EXPECT_EQ(once([](WrittenTick&) {}), "zero within 10 ms of the second missed sample");
  EXPECT_EQ(witness.missed_samples(), 11u);
}

}  // namespace tact::model::limit_witness_test
