// SPDX-License-Identifier: Apache-2.0
// What tactd --check tells of an organ with a hole.
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::open_organ_note_test {

TEST(OpenOrganNote, TellsTheBoundaryEdgesAndWhatIsNotFeltThere) {
  const std::string note = open_organ_note(tests::make_plate_scene());  // 20 x 20 cells
  EXPECT_NE(note.find("plate.toml: the organ is open, with 80 boundary edges; beside the boundary "
                      "of an open surface there is no inside"),
            std::string::npos)
      << note;
}

TEST(OpenOrganNote, AClosedOrganNeedsNone) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_ball(0.05, 2);
  EXPECT_EQ(open_organ_note(scene), "");
}

TEST(OpenOrganNote, NoShippedSceneNeedsOne) {
  for (const std::string name :
       {"grasper", "gum", "heart", "liver", "liver_source", "liver_twist", "maintenance", "skin"}) {
    const auto scene =
        model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(open_organ_note(*scene), "") << name;
  }
}

}  // namespace tact::firmware::admission::open_organ_note_test
