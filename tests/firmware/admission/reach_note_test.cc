// SPDX-License-Identifier: Apache-2.0
// What tactd --check reports of an organ that no stroke reaches, or that has the size of a house.
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::reach_note_test {

TEST(ReachNote, ReportsHowFarTheNearestStrokeStaysAway) {
  model::scene::Scene scene = tests::make_plate_scene();
  EXPECT_EQ(reach_note(scene), "");
  model::mesh::shift(scene.organ_mesh, {0, 0, -0.020});  // the sphere comes to 4 + 6 mm below 0
  const std::string note = reach_note(scene);
  EXPECT_NE(note.find("plate.toml: no stroke of the hand reaches the organ, 10 mm are missing"),
            std::string::npos)
      << note;
  EXPECT_NE(note.find("organ.position_m"), std::string::npos) << note;
  scene.tool.spheres.push_back({{0, 0, -0.01}, 0.004});  // a longer tool
  EXPECT_EQ(reach_note(scene), "");
}

TEST(ReachNote, ContactBetweenTwoWaypointsCountsAsReached) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.hand.path = {{.time_s = 0.0, .position_m = {-0.2, 0, 0.05}},
                     {.time_s = 1.0, .position_m = {0.2, 0, -0.05}}};
  EXPECT_EQ(reach_note(scene), "");
}

TEST(ReachNote, AHandWithoutStrokesIsNoMistake) {
  model::scene::Scene scene = tests::make_plate_scene();
  model::mesh::shift(scene.organ_mesh, {0, 0, -0.1});
  scene.hand.path.resize(1);
  EXPECT_EQ(reach_note(scene), "");
}

TEST(ReachNote, AnOrganInTheWrongUnitIsReportedAsThat) {
  for (const double unit : {100.0, 0.01}) {
    model::scene::Scene scene = tests::make_plate_scene();
    scene.organ_mesh = tests::make_plate(0.2 * unit, 20);
    EXPECT_NE(reach_note(scene).find("is organ.mesh_unit_m the unit"), std::string::npos) << unit;
  }
}

TEST(ReachNote, EveryShippedSceneIsReached) {
  for (const std::string name :
       {"grasper", "gum", "heart", "liver", "liver_source", "liver_twist", "maintenance", "skin"}) {
    const auto scene =
        model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(reach_note(*scene), "");
  }
}

}  // namespace tact::firmware::admission::reach_note_test
