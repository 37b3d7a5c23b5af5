// The map of a scene must be of its organ; what it says of each vertex is compared with the middle.
#include "model/tissue_map.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tact::model {
namespace {

Scene liver(const std::vector<std::string>& overrides = {}) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", overrides);
  EXPECT_TRUE(scene) << scene.error().sentence;
  return scene ? std::move(*scene) : Scene{};
}

std::string refusal(const Scene& scene) {
  const auto map = read_scene_map(scene);
  return map ? "" : map.error().sentence;
}

bool ends_with_command(const std::string& said, const Scene& scene) {
  return said.ends_with("tact-condense " + scene.path + " --out " + scene.compliance.map_path);
}

TEST(TissueMap, IsReadWhereItBelongs) {
  EXPECT_EQ(refusal(liver()), "");
  EXPECT_EQ(refusal(liver({"elastic.youngs_modulus_Pa=9000"})), "") << "the map holds r times E";
}

TEST(TissueMap, AMissingFileHasOneCure) {
  const Scene scene = liver({"compliance.map=none.compliance"});
  const std::string said = refusal(scene);
  EXPECT_NE(said.find("compliance.map names " + scene.compliance.map_path + ", no such file; "),
            said.npos)
      << said;
  EXPECT_TRUE(ends_with_command(said, scene)) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), ';'), 1) << said;
}

TEST(TissueMap, RefusesTheMapOfAnotherOrgan) {
  const Scene other_mesh = liver({"organ.mesh=meshes/heart_10026.obj"});
  EXPECT_NE(refusal(other_mesh).find("belongs to another organ mesh"), std::string::npos);
  EXPECT_TRUE(ends_with_command(refusal(other_mesh), other_mesh)) << refusal(other_mesh);
  const Scene other_nu = liver({"elastic.poisson_ratio=0.4"});
  EXPECT_NE(refusal(other_nu).find("was made for Poisson's ratio 0.45"), std::string::npos);
  EXPECT_TRUE(ends_with_command(refusal(other_nu), other_nu));
  EXPECT_NE(refusal(liver({"elastic.fixed_max_m=[1, -0.030, 1]"})).find("another held box"),
            std::string::npos);
  Scene no_body = liver();
  no_body.elastic.reset();
  EXPECT_NE(refusal(no_body).find("needs a section [elastic]"), std::string::npos);
}

TEST(TissueMap, FactorsGrowWithTheCoordinateAndAreOneInTheMiddle) {
  const auto family = read_scene_family(liver());
  ASSERT_TRUE(family) << family.error().sentence;
  const std::vector<float> coordinate{16.0F, 0.0F, 8.0F, 8.25F, 3.0F};
  for (const double depth_m : {0.004, -0.004}) {
    const std::vector<float> factor = stiffness_factors(*family, coordinate, depth_m);
    EXPECT_EQ(factor[2], 1.0F);
    EXPECT_LT(factor[1], factor[4]);
    EXPECT_LT(factor[4], 1.0F);
    EXPECT_GT(factor[3], 1.0F);
    EXPECT_GT(factor[0], factor[3]);
    const auto force_N = [&](std::size_t k) { return family->curve[k].respond(depth_m).force_N; };
    EXPECT_NEAR(factor[0], force_N(16) / force_N(8), 1e-6);
    EXPECT_NEAR(factor[3], 0.75 + 0.25 * force_N(9) / force_N(8), 1e-6);
  }
}

}  // namespace
}  // namespace tact::model
