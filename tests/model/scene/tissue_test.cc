// SPDX-License-Identifier: Apache-2.0
// A tissue that the checks before the loop have pressed renders as a fresh one.
#include "model/scene/tissue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "model/scene/press_sweep.h"
#include "tests/support/message.h"

namespace tact::model::scene::tissue_test {

struct Shipped {
  const char* name;
  bool is_same;  // the check presses the tissue itself
};

class CheckTissueOf : public testing::TestWithParam<Shipped> {};

std::vector<PressStep> pressed(const Scene& scene, const Tissue& tissue) {
  const PressPoint place = press_points(scene, 1, true, false).front();
  std::vector<PressStep> steps;
  press_once(tissue.contact_scene(), scene.hand_inward, place, {.depth_m = 0.004},
             [&](const PressStep& step) { steps.push_back(step); });
  return steps;
}

TEST_P(CheckTissueOf, LeavesTheForceOfALaterContactAsItIs) {
  const auto scene =
      load_scene(std::string(TACT_SOURCE_DIR) + "/model/scenes/" + GetParam().name, {});
  ASSERT_EQ(tests::message_of(scene), "");
  const auto tissue = std::move(*make_tissue(*scene)), fresh = std::move(*make_tissue(*scene));
  const auto check = tissue_for_check(*scene, *tissue);
  ASSERT_EQ(tests::message_of(check), "");
  EXPECT_EQ(check->tissue == tissue.get(), GetParam().is_same);
  const auto places = press_points(*scene, 2, true, false);
  ASSERT_EQ(
      tests::message_of(sweep_presses(*scene, places, {.checks_energy = false}, {}, check->tissue)),
      "");
  const auto used = pressed(*scene, *tissue), wanted = pressed(*scene, *fresh);
  ASSERT_EQ(used.size(), wanted.size());
  double largest_N = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    EXPECT_EQ(used[i].force_N, wanted[i].force_N) << i;
    largest_N = std::max(largest_N, used[i].along_N);
  }
  EXPECT_GT(largest_N, 0.05) << "nothing was pressed: it proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Scenes, CheckTissueOf,
                         testing::Values(Shipped{"liver.toml", true}, Shipped{"skin.toml", true},
                                         Shipped{"gum.toml", false}),
                         [](const auto& scene) {
                           const std::string name = scene.param.name;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace tact::model::scene::tissue_test
