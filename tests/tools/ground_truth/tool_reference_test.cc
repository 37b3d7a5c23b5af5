// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/tool_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_scene.h"
#include "tests/tools/ground_truth/damaged_file.h"
#include "tools/ground_truth/reference_fits.h"

namespace tact::tools::ground_truth::tool_reference_test {

using model::Vec3;

const std::string kCases = R"("orientation_wxyz": [1, 0, 0, 0], "cases": [
  {"depth_m": 0.001, "force_N": 0.03, "sphere_N": [0.01, 0.02], "force_error_ratio": 0.01},
  {"depth_m": 0.002, "force_N": 0.05, "sphere_N": [0.02, 0.03], "force_error_ratio": null}]})";
const std::string kExample = R"({"schema": "tact-tool-reference/1",
"mesh": "an \"organ\".obj", "mesh_hash": "0123456789abcdef", "solver": "by hand",
"youngs_modulus_Pa": 5000, "poisson_ratio": 0.45,
"fixed_min_m": [-1, -1, -1], "fixed_max_m": [1, -0.032, 1],
"spheres": [{"offset_m": [0, -0.004, 0.004], "radius_m": 0.004},
            {"offset_m": [0, 0.004, 0.004], "radius_m": 0.004}],
"places": [
 {"vertex": null, "point_m": [0, 0, 0], "direction": [0, 0, -1], )" +
                             kCases + R"(,
 {"vertex": null, "slid_m": [0, 0.02, 0], "point_m": [0, 0.02, -0.001], "direction": [0, 0, -1], )" +
                             kCases + R"(,
 {"vertex": 7, "point_m": [0.01, -0.02, 0.03], "direction": [0.6, 0, -0.8], )" +
                             kCases + "]}";

ToolReference example() {
  const auto data = tests::read_text(read_tool_reference, kExample);
  EXPECT_TRUE(data) << data.error().message;
  return *data;
}

void expect_error(const std::string& text, const std::string& from, const std::string& to,
                  const std::string& what) {
  tests::expect_error(read_tool_reference, text, from, to, what, "tact-lab reference SCENE --tool");
}

TEST(ToolReference, IsReadWithAllItsPlaces) {
  const ToolReference data = example();
  ASSERT_EQ(data.places.size(), 3U);
  EXPECT_EQ(data.places[1].orientation, model::Quat{});
  EXPECT_FALSE(data.places[0].vertex);
  EXPECT_EQ(name_of(data.places[1]), "slid 20 mm");
  EXPECT_EQ(data.places[2].vertex, 7U);
  EXPECT_EQ(data.places[2].cases[0].sphere_N, (std::vector<double>{0.01, 0.02}));
  EXPECT_TRUE(std::isnan(data.places[0].cases[1].force_error_ratio));
  EXPECT_EQ(data.sphere[1].offset_m.y, 0.004);
}

TEST(ToolReference, ATiltedPlaceHasANameOfItsOwn) {
  const std::string hands = R"({"vertex": null, "point_m": [0, 0, 0],)";
  std::string text = kExample;
  text.replace(text.find(hands), hands.size(), hands + R"( "tilt_deg": 20,)");
  const auto data = tests::read_text(read_tool_reference, text);
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(name_of(data->places[0]), "tilted 20");
  EXPECT_EQ(data->places[1].tilt_deg, 0.0);
}

TEST(ToolReference, NamesTheFileAndTheKeyOfADamage) {
  expect_error(kExample, "tact-tool-reference/1", "tact-reference/1", "schema");
  expect_error(kExample, "\"force_N\"", "\"force_mN\"", "force_N");
  expect_error(kExample, "\"force_N\": 0.03", "\"force_N\": -0.03", "above 0");
  expect_error(kExample, "\"depth_m\": 0.002", "\"depth_m\": 0.001", "depths");
  expect_error(kExample, "[0.6, 0, -0.8]", "[0.6, 0, -0.9]", "unit vector");
  expect_error(kExample, "[0.01, 0.02]", "[0.03]", "sphere_N");
}

class ToolReferenceFits : public testing::Test {
 protected:
  ToolReferenceFits() {
    scene_.organ.position_m = {0.0, 0.0, 0.01};
    scene_.elastic = model::scene::ElasticSettings{.youngs_modulus_Pa = 5000.0,
                                                   .poisson_ratio = 0.45,
                                                   .fixed_min_m = {-1, -1, -1},
                                                   .fixed_max_m = {1, -0.032, 1}};
    scene_.tool.spheres = reference_.sphere;
    scene_.hand_site_m = reference_.places[0].point_m + scene_.organ.position_m;
    reference_.places[2].point_m = scene_.organ_mesh.vertex_m[7] - scene_.organ.position_m +
                                   0.001 * reference_.places[2].direction;
  }
  void expect(const std::string& words) const {
    const auto error = check_tool_reference_fits(reference_, scene_);
    ASSERT_EQ(error.has_value(), !words.empty()) << (error ? error->message : "");
    if (!error) return;
    EXPECT_NE(error->message.find(words), std::string::npos) << error->message;
    EXPECT_NE(error->message.find("--tool --out FILE"), std::string::npos) << "the remedy";
  }

  model::scene::Scene scene_ = tests::make_plate_scene();
  ToolReference reference_ = example();
};

TEST_F(ToolReferenceFits, OnlyTheSceneOfTheReferenceIsAccepted) {
  expect("");  // a place may be moved along its way
  // As by a longer handle; across it the jaws would meet other tissue.
  for (auto& sphere : scene_.tool.spheres) sphere.offset_m += 0.09 * scene_.hand_inward;
  expect("");
  for (auto& sphere : scene_.tool.spheres) sphere.offset_m.y += 0.001;
  expect("spheres");
  scene_.tool.spheres = reference_.sphere;
  scene_.tool.spheres[1].radius_m *= 1.01;
  expect("spheres");
  scene_.tool.spheres = reference_.sphere;
  scene_.tool.spheres.pop_back();
  expect("spheres");
  scene_.tool.spheres = reference_.sphere;
  scene_.hand_site_m.x += 1e-4;
  expect("hand.site_m");
  scene_.hand_site_m.x -= 1e-4;
  reference_.places[2].point_m.y += 1e-4;
  expect("vertex 7");
  reference_.places[2].point_m.y -= 1e-4;
  reference_.places[1].point_m.y += 1e-4;
  expect("hand.site_m");
  reference_.places[1].point_m.y -= 1e-4;
  scene_.elastic->youngs_modulus_Pa = 4000.0;
  expect("youngs_modulus_Pa");
  scene_.elastic.reset();
  expect("[elastic]");
}

TEST(ToolReference, ShipsTheLiver) {
  const auto data = read_tool_reference(TACT_SOURCE_DIR "/tests/data/reference/liver_tool.json");
  ASSERT_TRUE(data) << data.error().message;
  ASSERT_EQ(data->places.size(), 9U);
  // Two jaws at the hand's site, finite elements and boundary elements by others: 1, 2, 5, 10 mm.
  const double known_N[] = {0.01862, 0.04888, 0.15939, 0.36985};
  for (const ToolPoint& place : data->places) {
    ASSERT_EQ(place.cases.size(), 4U);
    double last_N = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const ToolCase& c = place.cases[k];
      EXPECT_GT(c.force_N, last_N) << "deeper is harder";
      EXPECT_NEAR(c.sphere_N[0] + c.sphere_N[1], c.force_N, 1e-6);
      EXPECT_LT(c.force_error_ratio, 0.08);
      if (name_of(place) == "hand's") EXPECT_NEAR(c.force_N, known_N[k], 0.03 * known_N[k]);
      last_N = c.force_N;
    }
  }
}

}  // namespace tact::tools::ground_truth::tool_reference_test
