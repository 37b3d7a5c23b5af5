// SPDX-License-Identifier: Apache-2.0
// The map of a scene must be of its organ.
#include "model/scene/tissue_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/scene/compliance_file.h"

namespace tact::model::scene::tissue_map_test {

Scene liver(const std::vector<std::string>& overrides = {}) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", overrides);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

std::string refusal(const Scene& scene) {
  const auto map = read_scene_map(scene);
  return map ? "" : map.error().message;
}

/// A map beside the scene, and never the one that the scene names: it may be another scene's.
bool ends_with_command(const std::string& said, const Scene& scene) {
  const std::string own = TACT_SOURCE_DIR "/model/scenes/liver.compliance";
  return said.ends_with("write compliance.map = \"liver.compliance\", then tact-lab condense " +
                        scene.path + " --out " + own);
}

TEST(TissueMap, MapOfTheSameOrganIsAccepted) {
  EXPECT_EQ(refusal(liver()), "");
  EXPECT_EQ(refusal(liver({"elastic.youngs_modulus_Pa=9000"})), "") << "the map holds r times E";
}

TEST(TissueMap, AMissingFileHasOneRemedy) {
  const Scene scene = liver({"compliance.map=none.compliance"});
  const std::string said = refusal(scene);
  EXPECT_NE(said.find("compliance.map names " + scene.compliance.map_path + ", no such file; "),
            said.npos)
      << said;
  EXPECT_TRUE(ends_with_command(said, scene)) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), ';'), 1) << said;
}

TEST(TissueMap, AMissingMapOfItsOwnIsMadeUnderItsName) {
  const Scene scene = liver({"compliance.map=liver.compliance"});
  const std::string said = refusal(scene);
  EXPECT_TRUE(said.ends_with("make it: tact-lab condense " + scene.path + " --out " +
                             scene.compliance.map_path))
      << said;
}

TEST(TissueMap, BelongsToTheLumpsInItsOrgan) {
  Scene scene = liver();
  scene.elastic->inclusions = {
      {.center_m = {0.0, 0.0, 0.01}, .radius_m = 0.005, .youngs_modulus_Pa = 5e4}};
  EXPECT_NE(refusal(scene).find("was made for other [[elastic.inclusion]]"), std::string::npos);
  EXPECT_TRUE(ends_with_command(refusal(scene), scene));
  const std::uint32_t hash = inclusions_hash(*scene.elastic);
  scene.elastic->youngs_modulus_Pa *= 2.0;
  EXPECT_NE(inclusions_hash(*scene.elastic), hash) << "the ratio counts";
  scene.elastic->inclusions[0].youngs_modulus_Pa *= 2.0;
  EXPECT_EQ(inclusions_hash(*scene.elastic), hash);
  scene.elastic->inclusions[0].radius_m = 0.006;
  EXPECT_NE(inclusions_hash(*scene.elastic), hash);
  scene.elastic->inclusions.clear();
  EXPECT_EQ(refusal(scene), "");
}

TEST(TissueMap, RefusesTheMapOfAnotherOrgan) {
  const Scene other_mesh = liver({"organ.mesh=meshes/heart_4002.obj"});
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

}  // namespace tact::model::scene::tissue_map_test
