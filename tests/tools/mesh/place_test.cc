// SPDX-License-Identifier: Apache-2.0
// tact-mesh --place puts an organ from anywhere under the tool of a scene.
#include "tools/mesh/place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "model/mesh/mesh.h"
#include "model/scene/scene.h"
#include "tests/support/mesh_files.h"
#include "tools/mesh/unit.h"

namespace tact::tools::mesh::place_test {

using model::Vec3;
using nlohmann::json;

namespace fs = std::filesystem;

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";

class Place : public testing::Test {
 protected:
  /// The liver's scene with absolute names, so that it may lie anywhere.
  Place() {
    std::string text = tests::read_text(kScenes + "liver.toml");
    for (std::size_t at = 0; (at = text.find("\"meshes/", at)) != text.npos; at += 10)
      text.insert(at + 1, kScenes);
    before_ = text;
    scene_ = temp_.write("scene.toml", text);
    // The liver in scanner coordinates, lying on its front: x to z, z to -x, and far away.
    std::string organ;
    const std::string liver = tests::read_text(kScenes + "meshes/liver_3116.obj");
    std::istringstream lines(liver);
    for (std::string line, word; std::getline(lines, line);) {
      std::istringstream words(line);
      Vec3 p;
      if (line.starts_with("v ") && words >> word >> p.x >> p.y >> p.z)
        line = "v " + std::to_string(-p.z - 110.3) + " " + std::to_string(p.y - 205.1) + " " +
               std::to_string(p.x - 1310.7);
      organ += line + "\n";
    }
    organ_ = temp_.write("organ.obj", organ);
  }

  tests::Ran run(const std::string& arguments) const {
    return tests::run_apart(temp_, "tact-mesh", arguments);
  }
  /// The highest vertex of the organ, W, is where the hand touches.
  void expect_top_at_site(const std::string& scene_path) {
    const auto scene = model::scene::load_scene(scene_path, {});
    ASSERT_TRUE(scene) << scene.error().sentence;
    double nearest_m = 1.0;
    for (const Vec3& p : scene->organ_mesh.vertex_m)
      nearest_m = std::min(nearest_m, norm(p - scene->hand_site_m));
    EXPECT_LT(nearest_m, 1e-6);
    const auto sum = model::mesh::summarize(scene->organ_mesh);
    const Vec3 size_m = sum.high_m - sum.low_m;
    EXPECT_NEAR(std::max({size_m.x, size_m.y, size_m.z}), 0.15, 0.02) << "the unit was found";
  }

  tests::TempDirectory temp_;
  std::string scene_, organ_, before_;
};

TEST_F(Place, TheTopOfTheOrganComesToTheSiteAndIsNotTurned) {
  const tests::Ran printed = run(organ_ + " --place " + scene_);
  ASSERT_EQ(printed.status, 0) << printed.err;
  for (const std::string& part :
       {"[organ]\nmesh = \"" + fs::path(organ_).lexically_normal().string() +
            "\"\nmesh_unit_m = 0.001\n",
        std::string("unit       taken as mm: "),
        std::string("orientation_deg = [0, 0, 0]\nposition_m = ["),
        std::string("[hand]\nsite_m = [0, 0, 0]\n")})
    EXPECT_NE(printed.out.find(part), std::string::npos) << part << printed.out;
  EXPECT_EQ(tests::read_text(scene_), before_) << "nothing is written without --write";
  ASSERT_EQ(run(organ_ + " --write --place " + scene_).status, 0);
  expect_top_at_site(scene_);
}

TEST_F(Place, AChosenPointIsTurnedTowardsTheTool) {
  const auto liver = model::scene::load_scene(kScenes + "liver.toml", {});
  ASSERT_TRUE(liver);
  // What lies on top in the liver's own scene, in the scanner's frame.
  ASSERT_EQ(run(organ_ + " --write --point -140.3 -205.1 -1310.7 --place " + scene_).status, 0);
  expect_top_at_site(scene_);
  const auto scene = model::scene::load_scene(scene_, {});
  ASSERT_TRUE(scene);
  std::size_t touched = 0;
  for (std::size_t v = 0; v < scene->organ_mesh.vertex_m.size(); ++v)
    if (norm(scene->organ_mesh.vertex_m[v] - scene->hand_site_m) <
        norm(scene->organ_mesh.vertex_m[touched] - scene->hand_site_m))
      touched = v;
  EXPECT_LT(norm(scene->organ_mesh.vertex_normal[touched] + scene->hand_inward), 1e-4);
}

TEST_F(Place, WriteChangesItsOwnKeysAndNoOtherLine) {
  ASSERT_EQ(run(organ_ + " --write --place " + scene_).status, 0);
  std::istringstream was(before_), is(tests::read_text(scene_));
  std::vector<std::string> gone, come;
  std::vector<std::string> old_lines, new_lines;
  for (std::string line; std::getline(was, line);) old_lines.push_back(line);
  for (std::string line; std::getline(is, line);) new_lines.push_back(line);
  for (const auto& line : old_lines)
    if (std::find(new_lines.begin(), new_lines.end(), line) == new_lines.end())
      gone.push_back(line);
  EXPECT_EQ(new_lines.size(), old_lines.size());
  EXPECT_EQ(gone.size(), 4u) << "mesh, orientation_deg, position_m and site_m";
  const std::string once = tests::read_text(scene_);
  ASSERT_EQ(run(organ_ + " --write --place " + scene_).status, 0);
  EXPECT_EQ(tests::read_text(scene_), once) << "the same again changes nothing";
}

TEST_F(Place, RefusesWhatItCannotWriteAndLeavesTheSceneAsItWas) {
  std::string text = before_;
  text.replace(text.find("position_m = ["), 14, "position_m = [\n ");
  const std::string split = temp_.write("split.toml", text);
  tests::Ran ran = run(organ_ + " --write --place " + split);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("organ.position_m goes over several lines"), std::string::npos) << ran.err;
  EXPECT_EQ(tests::read_text(split), text);
  for (const std::string& arguments :
       {organ_ + " --write", organ_ + " --point 1 2 3", organ_ + " --point 1 2 --place " + scene_,
        organ_ + " --place " + temp_.path() + "/none.toml"})
    EXPECT_EQ(run(arguments).status, 2) << arguments;
  EXPECT_EQ(tests::read_text(scene_), before_);
}

TEST_F(Place, TellsMachinesToo) {
  const tests::Ran ran = run(organ_ + " --json --unit cm --place " + scene_);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["unit_from"], "named");
  const json told = json::parse(ran.out)["placement"];
  EXPECT_EQ(told["mesh_unit_m"], 0.01) << "a unit that is named is not guessed";
  EXPECT_EQ(told["orientation_deg"], json::array({0.0, 0.0, 0.0}));
  const json guessed = json::parse(run(organ_ + " --json --place " + scene_).out);
  EXPECT_EQ(guessed["unit_from"], "size");
  EXPECT_EQ(guessed["unit_m"], guessed["placement"]["mesh_unit_m"]) << "one unit, told once";
}

TEST(LikelyUnit, IsTheOneThatMakesAnOrgan) {
  EXPECT_EQ(likely_unit_m(150.0), 0.001);
  EXPECT_EQ(likely_unit_m(40.0), 0.001);
  EXPECT_EQ(likely_unit_m(15.0), 0.01);
  EXPECT_EQ(likely_unit_m(0.15), 1.0);
}

}  // namespace tact::tools::mesh::place_test
