// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware/admission/refusals.h"
#include "hal/can/can_settings.h"

namespace tact::firmware::admission::unattended_test {

TEST(Unattended, AServiceDoesNotHomeOnAJigWithoutAPerson) {
  model::scene::Scene scene;
  for (const char* kind : {"can-odrive", "can-cia402", "can-moteus"}) {
    scene.device.kind = kind;
    scene.device.of<hal::can::CanSettings>().homing = hal::can::Homing::kJig;
    const auto refused = why_not_unattended(scene, true);
    ASSERT_TRUE(refused) << kind;
    EXPECT_NE(refused->message.find("\"absolute\""), std::string::npos) << "the remedy";
    EXPECT_EQ(refused->message.find("\"index\"") != std::string::npos,
              scene.device.kind == "can-odrive")
        << "the others cannot";
    EXPECT_FALSE(why_not_unattended(scene, false)) << "a person sees the arms";
    scene.device.of<hal::can::CanSettings>().homing = hal::can::Homing::kAbsolute;
    EXPECT_FALSE(why_not_unattended(scene, true));
  }
  scene.device.kind = "sim-delta";
  scene.device.of<hal::can::CanSettings>().homing = hal::can::Homing::kJig;
  EXPECT_FALSE(why_not_unattended(scene, true)) << "has no drives";
}

}  // namespace tact::firmware::admission::unattended_test
