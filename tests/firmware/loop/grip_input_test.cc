// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/grip_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::grip_input_test {

constexpr GripSettings kToggle{.toggles = true};

std::vector<double> ratios(GripInput grip, const std::vector<double>& hand) {
  std::vector<double> out;
  for (const double ratio : hand) out.push_back(grip.step(ratio, std::nullopt));
  return out;
}

TEST(GripInput, HoldFollowsTheHand) {
  const std::vector<double> hand{0.0, 0.3, 0.9, 1.0, 0.2};
  EXPECT_EQ(ratios(GripInput({}), hand), hand);
}

TEST(GripInput, ToggleClosesByOnePressAndOpensByTheNext) {
  EXPECT_EQ(ratios(GripInput(kToggle), {0, 1, 1, 0, 0, 1, 0, 1, 0}),
            (std::vector<double>{0, 1, 1, 1, 1, 0, 0, 1, 1}));
}

TEST(GripInput, AHalfPressTogglesNothing) {
  EXPECT_EQ(ratios(GripInput(kToggle), {0, 0.6, 0, 0.8, 0.6, 0.8, 0.4, 0.8}),
            (std::vector<double>{0, 0, 0, 1, 1, 1, 1, 0}));
}

TEST(GripInput, SwitchPressedAtTheStartDoesNotToggle) {
  EXPECT_EQ(ratios(GripInput(kToggle), {1, 1, 0, 1}), (std::vector<double>{0, 0, 0, 1}));
}

TEST(GripInput, ARatioThatIsNoNumberStaysOne) {
  for (const bool toggles : {false, true})
    EXPECT_TRUE(std::isnan(GripInput({.toggles = toggles}).step(std::nan(""), std::nullopt)));
}

TEST(GripInput, AGripSwitchTakesThePlaceOfTheDevicesOwn) {
  GripInput grip{{}};
  EXPECT_EQ(grip.step(0.0, true), 1.0);
  EXPECT_EQ(grip.step(1.0, false), 0.0);
}

/// Of the loop: what reaches contact and the record.
class GripLoop : public PuppetLoop {
 protected:
  double recorded() {
    loop.step();
    return newest().input.sample.tool.grip_ratio;
  }
};

TEST_F(GripLoop, ASwitchOnTheLinesClosesTheJawsAlsoWithoutAFreshSample) {
  EXPECT_EQ(recorded(), 0.0);
  lines.grip_pressed = true;
  device.silent = true;
  EXPECT_EQ(recorded(), 1.0);
  lines.grip_pressed.reset();
  EXPECT_EQ(recorded(), 0.0) << "what the line said is not the device's own ratio";
}

}  // namespace tact::firmware::loop::grip_input_test
