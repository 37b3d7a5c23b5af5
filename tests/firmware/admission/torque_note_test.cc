// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::torque_note_test {

const hal::DeviceInfo kWithout{.name = "three axes", .grip = hal::GripKind::kNone};
const hal::DeviceInfo kWith{.name = "six axes", .max_torque_Nm = 0.2, .grip = hal::GripKind::kNone};

TEST(TorqueNote, SaysThatTheTorqueOfALeverIsLostWithoutMotorsForIt) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.tool.spheres = {{{0, 0.003, -0.093}, 0.004}, {{0, -0.003, -0.093}, 0.004}};
  EXPECT_EQ(torque_note(scene, kWithout),
            "plate.toml: this device has no torque: of the tool's wrench the force is felt at the "
            "handle, and the torque of its 93 mm lever is lost");
  EXPECT_EQ(torque_note(scene, kWith), "");
}

TEST(TorqueNote, IsEmptyWhereNothingWouldTurn) {
  model::scene::Scene scene = tests::make_plate_scene();
  EXPECT_EQ(torque_note(scene, kWithout), "") << "the sphere is at the handle";
  scene.tool.spheres[0].offset_m = {0, 0, -0.1};
  scene.limits.torque_Nm = 0.0;
  EXPECT_EQ(torque_note(scene, kWithout), "") << "the scene lets no torque through";
}

}  // namespace tact::firmware::admission::torque_note_test
