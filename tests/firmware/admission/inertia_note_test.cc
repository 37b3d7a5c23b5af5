// SPDX-License-Identifier: Apache-2.0
// What tactd reports before the loop starts: a stroke that is too fast for its law.
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::inertia_note_test {

TEST(InertiaNote, ReportsOfAStrokeThatIsTooFastForALawWithoutInertia) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.elastic = {.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
  scene.hand_site_m = {0, 0, 0};
  scene.hand_inward = {0, 0, -1};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // 10 mm deep, from the surface: 15/8 of 10 mm in the time, at 5 mm, where IN-2 says 109 mm/s
  const auto reported = [&](double duration_s) {
    scene.hand.path = {{.time_s = 0.0, .position_m = {0, 0, 0.004}},
                       {.time_s = duration_s, .position_m = {0, 0, -0.006}},
                       {.time_s = duration_s + 0.05, .position_m = {0, 0, 0.05}}};
    return inertia_note(scene, tissue->law());
  };
  EXPECT_EQ(reported(0.5), "") << "a release is not a press";
  const std::string fast = reported(0.05);
  for (const char* part :
       {"plate.toml: a stroke of the hand presses with",
        "mm/s on the inertia of "
        "tissue, which this law leaves out, is more than 7 % of the force there"})
    EXPECT_NE(fast.find(part), std::string::npos) << fast;
  scene.elastic.reset();
  EXPECT_NE(reported(0.02), "") << "the law's own half-space";
}

TEST(InertiaNote, OnlyTheHeartSceneIsPressedTooFastForItsLaw) {
  for (const std::string name :
       {"grasper", "gum", "heart", "liver", "liver_source", "liver_twist", "maintenance", "skin"}) {
    const auto scene =
        model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene) << scene.error().message;
    const auto tissue = std::move(*model::scene::make_tissue(*scene));
    const std::string note = inertia_note(*scene, tissue->law());
    EXPECT_EQ(note.empty(), name != "heart") << note;
  }
}

}  // namespace tact::firmware::admission::inertia_note_test
