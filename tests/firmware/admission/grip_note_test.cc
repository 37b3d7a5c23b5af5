// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "hal/lines_settings.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::grip_note_test {

const hal::DeviceInfo kCannot{.name = "bare", .grip = hal::GripKind::kNone};

model::scene::Scene gripping_scene() {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.hand.path[1].grip_ratio = 1.0;
  return scene;
}

TEST(GripNote, GrippingSceneOnADeviceWithoutGripIsReported) {
  EXPECT_EQ(grip_note(gripping_scene(), kCannot),
            "plate.toml: this scene grips; this device cannot: connect device.lines.grip, or "
            "nothing is held, pulled or torn");
}

TEST(GripNote, IsEmptyWhereTheSceneGripsNothing) {
  EXPECT_EQ(grip_note(tests::make_plate_scene(), kCannot), "");
}

TEST(GripNote, IsEmptyOnADeviceThatGripsInAnyWay) {
  for (const hal::GripKind kind :
       {hal::GripKind::kButton, hal::GripKind::kAngle, hal::GripKind::kForce})
    EXPECT_EQ(grip_note(gripping_scene(), {.name = "device", .grip = kind}), "");
}

TEST(GripNote, IsEmptyWhereTheGripLineIsWiredAndOnlyThere) {
  model::scene::Scene scene = gripping_scene();
  scene.device.of<hal::LinesSettings>().grip = 0;
  EXPECT_NE(grip_note(scene, kCannot), "") << "a line without a chip";
  scene.device.of<hal::LinesSettings>().chip = "board";
  EXPECT_EQ(grip_note(scene, kCannot), "");
  scene.device.of<hal::LinesSettings>().grip = -1;
  scene.device.of<hal::LinesSettings>().dead_man = 3;
  EXPECT_NE(grip_note(scene, kCannot), "") << "another line";
}

}  // namespace tact::firmware::admission::grip_note_test
