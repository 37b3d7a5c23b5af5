// SPDX-License-Identifier: Apache-2.0
#include "model/indent/table_law.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <tuple>

#include "model/law/linear_pull.h"
#include "model/law/series_law.h"
#include "model/units.h"
#include "tests/model/law/law_contract.h"

namespace tact::model::indent::table_law_test {

using Rows = std::vector<TableRow>;
using Truth = std::function<double(double)>;  // N of m

constexpr double kEnd_m = 0.012;

double exponential_N(double d_m) { return 0.02 * std::expm1(5.0 * d_m / kEnd_m); }
double toe_N(double d_m) { return 60.0 * (d_m - 0.004 * (1.0 - std::exp(-d_m / 0.004))); }
double hertz_N(double d_m) { return 1500.0 * std::pow(d_m, 1.5); }

/// Each row with noise of `share` of its force, and of `of_peak` of the largest.
Rows press(const Truth& truth_N, std::size_t rows, double share, double of_peak, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise;
  Rows out;
  for (std::size_t i = 0; i < rows; ++i) {
    const double d_m = kEnd_m * static_cast<double>(i) / static_cast<double>(rows - 1);
    const double force_N = truth_N(d_m) * (1.0 + share * noise(engine));
    out.push_back(
        {static_cast<int>(i) + 2, d_m, force_N + of_peak * truth_N(kEnd_m) * noise(engine)});
  }
  return out;
}

TableLaw make(const Rows& rows, const TableParameters& p = {}) { return *make_table_law(rows, p); }

double worst_ratio(const TableLaw& law, const Truth& truth_N, double from_m) {
  double worst = 0.0;
  for (double d_m = from_m; d_m <= 0.998 * kEnd_m; d_m += 1e-5)
    worst = std::max(worst, std::abs(law.respond(d_m).force_N / truth_N(d_m) - 1.0));
  return worst;
}

TEST(TableLaw, KeepsTheLawContractAloneWithPullAndInSeries) {
  for (const Truth& truth_N : {Truth(exponential_N), Truth(toe_N), Truth(hertz_N)}) {
    const TableLaw law = make(press(truth_N, 300, 0.01, 0.001, 1));
    tests::check_law_contract(law);
    tests::check_law_contract(
        *law::make_linear_pull(law, {.stiffness_N_per_m = 60, .limit_m = 10_mm}));
    tests::check_closed_stroke_returns_no_energy(*law::make_series_law(law, 0.01, law));
  }
}

TEST(TableLaw, HasConsistentDimensions) {
  tests::check_dimensions([](double m, double kg, double s) -> std::unique_ptr<law::Law> {
    Rows rows = press(hertz_N, 60, 0.0, 0.0, 1);
    // A depth of 12 m would be refused as a slip of the unit.
    for (TableRow& row : rows) row.depth_m *= m * 1e-2, row.force_N *= kg * m / (s * s);
    return std::make_unique<TableLaw>(make(rows));
  });
}

TEST(TableLaw, FollowsCurvesWithAPercentOfNoiseWithinSevenPercentLocally) {
  for (const auto& [name, truth_N, tenth_m] :
       {std::tuple<const char*, Truth, double>{"exponential", exponential_N, 6.6_mm},
        {"toe", toe_N, 3_mm},
        {"hertz", hertz_N, 2.6_mm}}) {  // where the force is a tenth of its peak
    double own = 0.0, of_peak = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const TableLaw law = make(press(truth_N, 240, 0.01, 0.0, seed));
      own = std::max(own, worst_ratio(law, truth_N, 0.2_mm));
      const TableLaw noisy = make(press(truth_N, 1200, 0.0, 0.01, seed));
      of_peak = std::max(of_peak, worst_ratio(noisy, truth_N, tenth_m));
    }
    RecordProperty(name, fmt::format("{:.4f} {:.4f}", own, of_peak));
    EXPECT_LT(own, 0.025) << name << ", noise of 1 % of the force, from 0.2 mm";
    EXPECT_LT(of_peak, 0.07) << name << ", noise of 1 % of the peak";
  }
}

TEST(TableLaw, AStraightLineIsThatSpring) {
  const TableLaw law =
      make(press([](double d_m) { return 50.0 * d_m; }, 100, 0.0, 0.0, 1), {.force_ratio = 2.0});
  EXPECT_NEAR(law.respond(6_mm).force_N, 0.6, 1e-6) << "times force_ratio";
  EXPECT_NEAR(law.respond(6_mm).energy_J, 0.5 * 100.0 * 0.006 * 0.006, 1e-8);
  EXPECT_NEAR(law.respond(6_mm).stiffness_N_per_m, 100.0, 1e-3);
}

TEST(TableLaw, InvalidLoadingRowsAreRefusedWithTheirRowNumber) {
  const auto refusal = [](const std::function<void(Rows&)>& spoil) {
    Rows rows = press(hertz_N, 100, 0.002, 0.0, 3);
    spoil(rows);
    const auto law = make_table_law(rows, {});
    return law ? std::string() : law.error().message;
  };
  EXPECT_EQ(refusal([](Rows&) {}), "");
  for (const auto& [words, spoil] : std::vector<std::pair<std::string, std::function<void(Rows&)>>>{
           {":62: the force falls from ",
            [](Rows& r) {
              for (std::size_t i = 60; i < 100; ++i) r[i].force_N *= 0.6;
            }},
           {":32: a force of -0.2 N draws the tool in", [](Rows& r) { r[30].force_N = -0.2; }},
           {":43: the depth falls from ",
            [](Rows& r) {
              for (std::size_t i = 41; i < 60; ++i) r[i].depth_m -= 0.002;
            }},
           {":2: the depth is -0.001 m", [](Rows& r) { r[0].depth_m = -0.001; }},
           {":40: the depth is 4.",
            [](Rows& r) {
              for (TableRow& row : r) row.depth_m *= 1e3;
              r.erase(r.begin(), r.begin() + 38);
            }},
           {": 3 rows; a curve needs 5", [](Rows& r) { r.resize(3); }},
           {": no force is above 0", [](Rows& r) {
              for (TableRow& row : r) row.force_N = -row.force_N;
            }}})
    EXPECT_TRUE(refusal(spoil).starts_with(words)) << words << " but " << refusal(spoil);
}

TEST(TableLaw, NoiseAloneIsNoRefusal) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto law = make_table_law(press(toe_N, 300, 0.0, 0.01, seed), {});
    EXPECT_TRUE(law) << law.error().message;
  }
}

/// The loading, then back on `share` of its force.
Rows with_unloading(double share) {
  Rows rows = press(hertz_N, 100, 0.0, 0.0, 1);
  for (std::size_t i = 99; i-- > 0;)
    rows.push_back({static_cast<int>(rows.size()) + 2, rows[i].depth_m, share * rows[i].force_N});
  return rows;
}

TEST(TableLaw, ReportsUnloadingApartAndNeverAveragesIt) {
  const auto refused = make_table_law(with_unloading(0.7), {});
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.starts_with(
      ":102: from here on the press is unloaded, which one force a depth cannot follow (30 % of "
      "the work is lost); write unloading = \"leave_out\""))
      << refused.error().message;
  const TableLaw law = make(with_unloading(0.7), {.leaves_unloading = true});
  EXPECT_NEAR(law.lost_ratio(), 0.3, 0.01);
  EXPECT_LT(worst_ratio(law, hertz_N, 0.2_mm), 0.03) << "of the loading alone";
  const auto gives = make_table_law(with_unloading(1.3), {.leaves_unloading = true});
  ASSERT_FALSE(gives);
  EXPECT_TRUE(gives.error().message.starts_with(":102: the unloading from here on gives back"))
      << gives.error().message;
}

TEST(TableLaw, AHeldPressIsNoLoadingEither) {
  Rows rows = press(hertz_N, 100, 0.0, 0.0, 1);
  for (int i = 1; i <= 40; ++i)
    rows.push_back({101 + i, kEnd_m, hertz_N(kEnd_m) * (1.0 - 0.005 * i)});
  const auto refused = make_table_law(rows, {});
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.starts_with(":102: from here on the press is held"))
      << refused.error().message;
}

}  // namespace tact::model::indent::table_law_test
