// SPDX-License-Identifier: Apache-2.0
// tact-mesh --align puts an organ from anywhere under the tool of a scene.
#include "tools/mesh/place.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "model/mesh/mesh.h"
#include "model/scene/scene.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"
#include "tools/mesh/held_box.h"
#include "tools/mesh/unit.h"

namespace tact::tools::mesh::place_test {

using model::Vec3;
using nlohmann::json;

namespace fs = std::filesystem;

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";

class PlaceOrgan : public testing::Test {
 protected:
  /// The liver's scene with absolute names, so that it may lie anywhere.
  PlaceOrgan() {
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
  /// The highest vertex of the organ, W, is where the hand presses.
  void expect_top_at_site(const std::string& scene_path) {
    const auto scene = model::scene::load_scene(scene_path, {});
    ASSERT_TRUE(scene) << scene.error().message;
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

TEST_F(PlaceOrgan, TheTopOfTheOrganComesToTheSiteAndIsNotTurned) {
  const tests::Ran printed = run(organ_ + " --align " + scene_);
  ASSERT_EQ(printed.status, 0) << printed.err;
  for (const std::string& part :
       {"[organ]\nmesh = \"" + fs::path(organ_).lexically_normal().string() +
            "\"\nmesh_unit_m = 0.001\n",
        std::string("unit       taken as mm: "),
        std::string("orientation_deg = [0, 0, 0]\nposition_m = ["),
        std::string("[hand]\nsite_m = [0, 0, 0]\n")})
    EXPECT_NE(printed.out.find(part), std::string::npos) << part << printed.out;
  EXPECT_EQ(tests::read_text(scene_), before_) << "nothing is written without --write";
  ASSERT_EQ(run(organ_ + " --write --align " + scene_).status, 0);
  expect_top_at_site(scene_);
}

TEST_F(PlaceOrgan, AChosenPointIsTurnedTowardsTheTool) {
  const auto liver = model::scene::load_scene(kScenes + "liver.toml", {});
  ASSERT_TRUE(liver);
  // What lies on top in the liver's own scene, in the scanner's frame.
  ASSERT_EQ(run(organ_ + " --write --point -140.3 -205.1 -1310.7 --align " + scene_).status, 0);
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

TEST_F(PlaceOrgan, WriteChangesItsOwnKeysAndNoOtherLine) {
  ASSERT_EQ(run(organ_ + " --write --align " + scene_).status, 0);
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
  ASSERT_EQ(run(organ_ + " --write --align " + scene_).status, 0);
  EXPECT_EQ(tests::read_text(scene_), once) << "the same again changes nothing";
}

TEST_F(PlaceOrgan, RefusesWhatItCannotWriteAndLeavesTheSceneAsItWas) {
  std::string text = before_;
  text.replace(text.find("position_m = ["), 14, "position_m = [\n ");
  const std::string split = temp_.write("split.toml", text);
  tests::Ran ran = run(organ_ + " --write --align " + split);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("organ.position_m goes over several lines"), std::string::npos) << ran.err;
  EXPECT_EQ(tests::read_text(split), text);
  for (const std::string& arguments :
       {organ_ + " --write", organ_ + " --point 1 2 3", organ_ + " --point 1 2 --align " + scene_,
        organ_ + " --align " + temp_.path() + "/none.toml"})
    EXPECT_EQ(run(arguments).status, 2) << arguments;
  EXPECT_EQ(tests::read_text(scene_), before_);
}

TEST_F(PlaceOrgan, APointFarFromTheOrganIsRefusedWithItsDistance) {
  const std::string cube =
      temp_.write("cube.obj", tests::kCubeVertices + tests::kCubeFaces);  // 10 units each way
  const auto point = [&](const std::string& xyz, const std::string& more = "") {
    return run(cube + " --unit cm --align " + scene_ + " --point " + xyz + more);
  };
  EXPECT_EQ(point("5 5 10").status, 0) << "the middle of a face, 7 units from the next vertex";
  const tests::Ran ran = point("5 5 100", " --write");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(
      ran.err,
      "tact-mesh: --point is 902.8 mm from the organ, which lies in X 0 to 10, Y 0 to 10, Z 0 "
      "to 10 of its file (cm); name a point of its surface, in the file's own frame and "
      "unit\n");
  EXPECT_EQ(tests::read_text(scene_), before_);
}

TEST_F(PlaceOrgan, ReportsWhatOfTheSceneWasMadeForAnotherOrgan) {
  const auto misfits = [&](const std::string& organ, const std::string& scene) {
    const tests::Ran ran = run(organ + " --json --align " + scene);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return json::parse(ran.out)["placement"]["misfits"];
  };
  EXPECT_EQ(misfits(kScenes + "meshes/liver_3116.obj", scene_), json::array())
      << "the scene's own organ";
  const json found = misfits(organ_, scene_);
  ASSERT_EQ(found.size(), 3u) << found;
  EXPECT_EQ(found[0]["keys"], "elastic.fixed_min_m, elastic.fixed_max_m");
  const std::string held = found[0]["text"], map = found[2]["text"];
  EXPECT_TRUE(held.starts_with("hold 0 of this organ's 6228 triangles; ")) << held;
  EXPECT_EQ(found[1]["keys"], "reference_site");
  EXPECT_EQ(found[1]["text"],
            "8 vertices of another organ; write vertices of this one, 0 to 3115, or remove these "
            "sections");
  EXPECT_EQ(found[2]["keys"], "compliance.map");
  EXPECT_NE(
      map.find("write compliance.map = \"scene.compliance\", then tact-lab condense " + scene_),
      map.npos)
      << map;

  // What is reported as a text is what must be written.
  const tests::Ran written = run(organ_ + " --write --align " + scene_);
  EXPECT_NE(written.out.find("\nnote       elastic.fixed_min_m, elastic.fixed_max_m: " + held),
            written.out.npos)
      << written.out;
  std::string text = tests::read_text(scene_);
  for (const std::string key : {"fixed_min_m = [", "fixed_max_m = ["}) {
    const std::size_t from = held.find(key), at = text.find(key);
    text.replace(at, text.find(']', at) + 1 - at, held, from, held.find(']', from) + 1 - from);
  }
  const json left = misfits(organ_, temp_.write("repaired.toml", text));
  ASSERT_EQ(left.size(), 1u) << left;
  EXPECT_EQ(left[0]["keys"], "compliance.map");
}

TEST_F(PlaceOrgan, AFailureLeavesTheSceneUntouched) {
  std::string text = before_;
  text.replace(text.find("position_m = ["), 10, "\"position_m\"");
  const std::string odd = temp_.write("odd.toml", text);
  struct stat was{}, is{};
  ASSERT_EQ(stat(odd.c_str(), &was), 0);
  const tests::Ran ran = run(organ_ + " --write --align " + odd);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("odd.toml: the keys of [organ] or [hand] stand in a form that is not "
                         "understood; run it without --write"),
            ran.err.npos)
      << ran.err;
  ASSERT_EQ(stat(odd.c_str(), &is), 0);
  EXPECT_EQ(is.st_ino, was.st_ino) << "was never written, not put back";
  EXPECT_EQ(tests::read_text(odd), text);
  EXPECT_EQ(run(organ_ + " --align " + odd).status, 0) << "they are printed";
}

TEST_F(PlaceOrgan, ANameThatIsNoTextIsRefused) {
  const std::string organ = temp_.write("b\xff.obj", tests::read_text(organ_));
  const tests::Ran ran = run(organ + " --align " + scene_);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("a scene is UTF-8, and this name is not; rename the file"), ran.err.npos)
      << ran.err;
}

TEST(HeldBox, IsTheTenthFarthestFromTheTool) {
  model::mesh::SurfaceMesh organ = tests::make_ball(0.1, 3);
  for (const auto& [inward, away] : std::vector<std::pair<Vec3, Vec3>>{
           {{0.0, 0.0, -1.0}, {0.0, 0.0, -0.1}}, {{-0.1, 0.9, 0.2}, {0.0, 0.1, 0.0}}}) {
    const HeldBox box = far_tenth(organ, inward);
    const std::size_t held = held_triangles(organ, box);
    EXPECT_GT(held, 0u);
    EXPECT_LT(held, organ.triangle.size() / 5);
    const auto inside = [&box = box](const Vec3& p) {
      return box.min_m.x <= p.x && p.x <= box.max_m.x && box.min_m.y <= p.y && p.y <= box.max_m.y &&
             box.min_m.z <= p.z && p.z <= box.max_m.z;
    };
    EXPECT_TRUE(inside(away));
    EXPECT_TRUE(inside(0.81 * away));
    EXPECT_FALSE(inside(0.79 * away)) << "a tenth of its height";
  }
}

TEST_F(PlaceOrgan, ReportsAsJsonToo) {
  const tests::Ran ran = run(organ_ + " --json --unit cm --align " + scene_);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["unit_from"], "named");
  const json reported = json::parse(ran.out)["placement"];
  EXPECT_EQ(reported["mesh_unit_m"], 0.01) << "a unit that is named is not guessed";
  EXPECT_EQ(reported["orientation_deg"], json::array({0.0, 0.0, 0.0}));
  const json guessed = json::parse(run(organ_ + " --json --align " + scene_).out);
  EXPECT_EQ(guessed["unit_from"], "size");
  EXPECT_EQ(guessed["unit_m"], guessed["placement"]["mesh_unit_m"]) << "one unit, stated once";
}

TEST(LikelyUnit, UnitThatGivesTheSizeOfAnOrganIsChosen) {
  EXPECT_EQ(likely_unit_m(150.0), 0.001);
  EXPECT_EQ(likely_unit_m(40.0), 0.001);
  EXPECT_EQ(likely_unit_m(15.0), 0.01);
  EXPECT_EQ(likely_unit_m(0.15), 1.0);
}

}  // namespace tact::tools::mesh::place_test
