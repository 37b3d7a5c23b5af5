// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/reference_data.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tools/ground_truth/damaged_file.h"

namespace tact::tools::ground_truth::reference_data_test {

const std::string kExample = R"({"schema": "tact-reference/1",
"mesh": "an \"organ\".obj", "mesh_hash": "0123456789abcdef", "solver": "by hand",
"youngs_modulus_Pa": 5000, "poisson_ratio": 0.45,
"fixed_min_m": [-1, -1, -1], "fixed_max_m": [1, -0.032, 1],
"tool_radius_m": 0.004, "ring_pitch_m": 0.001,
"sites": [{"vertex": 7, "point_m": [0.01, -0.02, 0.03], "direction": [0.6, 0, -0.8], "cases": [
  {"depth_m": 0.002, "large_strain": false, "force_N": 0.0481234, "contact_radius_m": 0.00266,
   "force_error_ratio": null, "profile_m": [0.002, 0.0015, 0.0004]},
  {"depth_m": -0.002, "large_strain": true, "force_N": -0.07, "contact_radius_m": 0.004,
   "force_error_ratio": 0.01, "profile_m": [-0.002, -0.002, -0.0005]}]}]}
)";

void expect_error(const std::string& text, const std::string& from, const std::string& to,
                  const std::string& what) {
  tests::expect_error(read_reference, text, from, to, what, "tact-lab reference SCENE --out");
}

TEST(ReferenceData, IsReadWithAllItsCases) {
  const auto data = tests::read_text(read_reference, kExample);
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->body.mesh, "an \"organ\".obj");
  EXPECT_EQ(data->body.fixed_max_m, (model::Vec3{1.0, -0.032, 1.0}));
  EXPECT_EQ(data->tool_radius_m, 0.004);
  ASSERT_EQ(data->sites.size(), 1U);
  ASSERT_EQ(data->sites[0].cases.size(), 2U);
  EXPECT_EQ(data->sites[0].vertex, 7U);
  EXPECT_EQ(data->sites[0].direction, (model::Vec3{0.6, 0.0, -0.8}));
  const auto &press = data->sites[0].cases[0], &pull = data->sites[0].cases[1];
  EXPECT_TRUE(press.is_press());
  EXPECT_DOUBLE_EQ(press.force_N, 0.0481234);
  EXPECT_TRUE(std::isnan(press.force_error_ratio)) << "not known";
  EXPECT_FALSE(pull.is_press());
  EXPECT_TRUE(pull.large_strain);
  EXPECT_EQ(pull.force_error_ratio, 0.01);
  EXPECT_EQ(pull.profile_m, (std::vector<double>{-0.002, -0.002, -0.0005}));
}

TEST(ReferenceData, NamesTheFileAndTheKeyOfADamage) {
  expect_error(kExample, "tact-reference/1", "tact-reference/0", "schema");
  expect_error(kExample, "\"force_N\"", "\"force_mN\"", "force_N");
  expect_error(kExample, "\"vertex\": 7", "\"vertex\": \"seven\"", "string");
  expect_error(kExample, "\"force_N\": 0.04", "\"force_N\": -0.04", "the other sign");
  expect_error(kExample, "[0.6, 0, -0.8]", "[0.6, 0, -0.9]", "unit vector");
  expect_error(kExample, "[0.002, 0.0015, 0.0004]", "[]", "profile_m");
  expect_error(kExample, "\"tool_radius_m\": 0.004", "\"tool_radius_m\": 0", "tool_radius_m");
  expect_error(kExample, "]}\n", "", "parse error");
  const auto none = read_reference("/nowhere/at/all.json");
  ASSERT_FALSE(none);
  EXPECT_EQ(
      none.error().message,
      "/nowhere/at/all.json: no such file; check the name, or make it: tact-lab reference SCENE "
      "--out FILE");
}

TEST(ReferenceData, ShipsTheLiver) {
  const auto data = read_reference(TACT_SOURCE_DIR "/tests/data/reference/liver.json");
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_GE(data->sites.size(), 8U);
  for (const SolvedSite& site : data->sites) {
    double last_N = 0.0;
    for (const ReferenceCase& c : site.cases) {
      if (c.large_strain) continue;
      EXPECT_EQ(c.profile_m.size(), 31U);
      EXPECT_NEAR(c.profile_m[0], c.depth_m, 1e-6) << "the tool's tip is where it was put";
      EXPECT_LT(std::abs(c.profile_m[30]), std::abs(c.profile_m[5]));
      EXPECT_GT(c.force_error_ratio, 0.0);
      EXPECT_LT(c.force_error_ratio, 0.03);
      if (!c.is_press()) continue;
      EXPECT_GT(c.force_N, last_N) << "deeper is harder";
      last_N = c.force_N;
    }
  }
}

}  // namespace tact::tools::ground_truth::reference_data_test
