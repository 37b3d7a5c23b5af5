// SPDX-License-Identifier: Apache-2.0
// What a scene says of its look, which no force knows.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace tact::model::scene::scene_look_test {

const std::string kPlain = TACT_SOURCE_DIR "/tests/data/scenes/plain.toml";

std::string complaint(const std::vector<std::string>& overrides) {
  const Result<Scene> scene = load_scene(kPlain, overrides);
  return scene ? "" : scene.error().message;
}

TEST(SceneLook, LooksAsItSaysElseLikeTissueUnderSteel) {
  const Result<Scene> plain = load_scene(kPlain, {});
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(plain->look.organ, "tissue");
  EXPECT_EQ(plain->look.tool, "steel");
  EXPECT_TRUE(plain->look.piece_color_ratio.empty());
  const Result<Scene> dressed = load_scene(kPlain, {"look.organ=\"skin\"", "look.tool=\"glove\""});
  ASSERT_TRUE(dressed) << dressed.error().message;
  EXPECT_EQ(dressed->look.organ, "skin");
  EXPECT_EQ(dressed->look.tool, "glove");
  const Result<Scene> cover = load_scene(TACT_SOURCE_DIR "/model/scenes/maintenance.toml", {});
  ASSERT_TRUE(cover) << cover.error().message;
  EXPECT_EQ(cover->look.organ, "paint");
  EXPECT_EQ(cover->look.piece_color_ratio,
            (std::vector<Vec3>{{0.92, 1.0, 1.06}, {1.55, 0.72, 0.4}}));
}

TEST(SceneLook, RefusesALookThatThePageCannotPaint) {
  const std::string stone = complaint({"look.organ=\"stone\""});
  EXPECT_NE(stone.find("look.organ"), stone.npos) << stone;
  for (const char* known : {"stone", "tissue", "skin", "glove", "paint", "steel"})
    EXPECT_NE(stone.find(known), stone.npos) << stone;
  const std::string bright = complaint({"look.piece=[{color_ratio=[1, 1, 4.1]}]"});
  EXPECT_NE(bright.find("color_ratio"), bright.npos) << bright;
  EXPECT_NE(bright.find("4"), bright.npos) << bright;
  std::string five = "look.piece=[";
  for (int i = 0; i < 5; ++i) five += "{color_ratio=[1, 1, 1]},";
  const std::string many = complaint({five + "]"});
  EXPECT_NE(many.find("look.piece"), many.npos) << many;
}

TEST(SceneLook, ShowsTheColoursOfItsMeshWhereItAsksForThem) {
  const std::string path = std::string(TACT_BINARY_DIR) + "/scene_look_test.obj";
  std::ofstream(path) << "v -.1 -.1 0 1 0 0\nv .1 -.1 0 0 1 0\nv 0 .1 0 0 0 1\nf 1 2 3\n";
  const std::vector<std::string> mesh{"organ.mesh=\"" + path + "\"", "organ.mesh_unit_m=1"};
  auto asked = mesh;
  asked.emplace_back("look.vertex_colors=true");
  const Result<Scene> coloured = load_scene(kPlain, asked);
  ASSERT_TRUE(coloured) << coloured.error().message;
  EXPECT_EQ(coloured->look.vertex_color,
            (std::vector<mesh::Rgb>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}));
  const Result<Scene> plain = load_scene(kPlain, mesh);
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->look.vertex_color.empty());
  EXPECT_NE(complaint({"look.vertex_colors=true"}).find("look.vertex_colors = true, but"),
            std::string::npos);
  const std::string both =
      complaint({"look.vertex_colors=true", "look.piece=[{color_ratio=[1, 1, 1]}]"});
  EXPECT_NE(both.find("both colour the organ"), both.npos) << both;
}

}  // namespace tact::model::scene::scene_look_test
