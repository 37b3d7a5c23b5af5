// SPDX-License-Identifier: Apache-2.0
// Safety lines on a chip that this test plays: it answers in place of libgpiod.
#include <gpiod.h>
#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <set>

#include "hal/gpio/gpio_lines.h"

struct gpiod_chip {};
struct gpiod_line {
  unsigned offset = 0;
  int level = 0;
  bool requested = false;
};

namespace {

struct PlayedChip {
  gpiod_chip chip;
  std::array<gpiod_line, 32> lines{};
  std::set<unsigned> not_given;
  int open = 0;
};
PlayedChip& played() {
  static PlayedChip one;
  return one;
}
int request(gpiod_line_bulk* bulk) {
  for (unsigned i = 0; i < bulk->num_lines; ++i) bulk->lines[i]->requested = true;
  return 0;
}

}  // namespace

extern "C" {
gpiod_chip* gpiod_chip_open(const char* /*path*/) {
  ++played().open;
  return &played().chip;
}
void gpiod_chip_close(gpiod_chip* /*chip*/) { --played().open; }
gpiod_line* gpiod_chip_get_line(gpiod_chip* /*chip*/, unsigned offset) {
  if (played().not_given.count(offset) != 0) {
    errno = EINVAL;
    return nullptr;
  }
  played().lines.at(offset).offset = offset;
  return &played().lines.at(offset);
}
int gpiod_line_request_bulk_input(gpiod_line_bulk* bulk, const char* /*consumer*/) {
  return request(bulk);
}
int gpiod_line_request_bulk_output(gpiod_line_bulk* bulk, const char* /*consumer*/,
                                   const int* /*levels*/) {
  return request(bulk);
}
int gpiod_line_get_value_bulk(gpiod_line_bulk* bulk, int* levels) {
  for (unsigned i = 0; i < bulk->num_lines; ++i) levels[i] = bulk->lines[i]->level;
  return 0;
}
int gpiod_line_set_value_bulk(gpiod_line_bulk* bulk, const int* levels) {
  for (unsigned i = 0; i < bulk->num_lines; ++i) bulk->lines[i]->level = levels[i];
  return 0;
}
bool gpiod_line_is_requested(gpiod_line* line) { return line->requested; }
bool gpiod_line_is_used(gpiod_line* line) { return line->requested; }
const char* gpiod_line_consumer(gpiod_line* /*line*/) { return nullptr; }
}

namespace tact::hal::gpio {
namespace {

constexpr int kEstopA = 16, kEstopB = 17, kDeadMan = 18, kEnable = 0, kHeartbeat = 1, kLed = 2,
              kScope = 3;

class GpioWiring : public testing::Test {
 protected:
  GpioWiring() {
    played() = {};
    settings_.chip = "board";
    settings_.estop_a = kEstopA, settings_.estop_b = kEstopB, settings_.dead_man = kDeadMan;
    settings_.enable = kEnable, settings_.heartbeat = kHeartbeat;
    settings_.led = kLed, settings_.scope = kScope;
    for (const int input : {kEstopA, kEstopB, kDeadMan}) set(input, 1);
  }
  static void set(int offset, int level) {
    played().lines.at(static_cast<std::size_t>(offset)).level = level;
  }
  model::Result<std::unique_ptr<SafetyLines>> open() const {
    return open_lines_of({.name = "gpiochip0",
                          .path = "/dev/gpiochip0",
                          .label = "board",
                          .lines = 32,
                          .bus = {},
                          .error = 0},
                         settings_);
  }

  model::LinesSettings settings_;
};

TEST_F(GpioWiring, ALineThatTheChipDoesNotGiveIsAnErrorAndNeverALineThatIsNotWired) {
  const std::array<std::pair<int, const char*>, 7> lines{{{kEstopA, "estop_a"},
                                                          {kEstopB, "estop_b"},
                                                          {kDeadMan, "dead_man"},
                                                          {kEnable, "enable"},
                                                          {kHeartbeat, "heartbeat"},
                                                          {kLed, "led"},
                                                          {kScope, "scope"}}};
  for (const auto& [offset, key] : lines) {
    played().not_given = {static_cast<unsigned>(offset)};
    const auto opened = open();
    ASSERT_FALSE(opened) << key << " was taken for a line that is not wired";
    EXPECT_EQ(
        opened.error().sentence,
        "device.lines." + std::string(key) + " is line " + std::to_string(offset) +
            " of gpiochip0 \"board\", which the chip does not give: Invalid argument; correct "
            "the number (gpioinfo gpiochip0 shows the lines), or check its driver (dmesg)");
    EXPECT_EQ(played().open, 0) << "the chip stays open";
  }
}

TEST_F(GpioWiring, EachInputStopsTheForceByItself) {
  const std::array<std::pair<int, model::Fault>, 3> inputs{
      {{kEstopA, model::Fault::kEmergencyStop},
       {kEstopB, model::Fault::kEmergencyStop},
       {kDeadMan, model::Fault::kDeadManReleased}}};
  for (const auto& [offset, fault] : inputs) {
    const auto opened = open();
    ASSERT_TRUE(opened) << opened.error().sentence;
    EXPECT_EQ((*opened)->read(1'000'000), model::Fault::kNone);
    set(offset, 0);
    EXPECT_EQ((*opened)->read(2'000'000), fault) << "line " << offset;
    set(offset, 1);
  }
}

TEST_F(GpioWiring, WhatIsNotWiredIsLeftAlone) {
  settings_.estop_a = settings_.estop_b = settings_.dead_man = -1;
  played().not_given = {kEstopA, kEstopB, kDeadMan};
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().sentence;
  EXPECT_EQ((*opened)->read(1'000'000), model::Fault::kNone);
}

}  // namespace
}  // namespace tact::hal::gpio
