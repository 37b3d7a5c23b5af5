// SPDX-License-Identifier: Apache-2.0
// Safety lines on a chip that this test plays: it answers in place of line_request.h.
#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <map>
#include <set>

#include "hal/gpio/gpio_lines.h"
#include "hal/gpio/line_request.h"
#include "hal/lines_settings.h"

namespace tact::hal::gpio {
namespace {

struct PlayedChip {
  std::array<int, 32> level{};
  std::set<int> requested, not_given;
  std::map<int, std::string> user;  // of another program
  int open = 0;
};
PlayedChip the_chip;
PlayedChip& played() RT_SAFE { return the_chip; }

}  // namespace

struct LineRequest::Lines {
  std::vector<int> offsets;

  ~Lines() {
    for (const int offset : offsets) played().requested.erase(offset);
  }
};
struct Chip::Handle {
  Handle() { ++played().open; }
  ~Handle() { --played().open; }
};

bool LineRequest::get(Levels& levels) RT_SAFE {
  for (std::size_t i = 0; i < lines_->offsets.size(); ++i)
    levels[i] = played().level[static_cast<std::size_t>(lines_->offsets[i])];
  return true;
}
bool LineRequest::set(const Levels& levels) RT_SAFE {
  for (std::size_t i = 0; i < lines_->offsets.size(); ++i)
    played().level[static_cast<std::size_t>(lines_->offsets[i])] = levels[i];
  return true;
}
std::vector<Edge> LineRequest::edges(std::chrono::milliseconds /*longest*/) { return {}; }

Chip::Chip(const std::string& /*path*/) : handle_(new Handle) {}
bool Chip::gives(int offset) const {
  errno = EINVAL;
  return played().not_given.count(offset) == 0;
}
std::optional<std::string> Chip::user_of(int offset) const {
  if (played().requested.count(offset) != 0) return "tactd";
  const auto found = played().user.find(offset);
  return found == played().user.end() ? std::nullopt : std::optional(found->second);
}
LineRequest Chip::request(LineUse /*use*/, std::span<const int> offsets, const char* /*consumer*/) {
  for (const int offset : offsets) {
    errno = EBUSY;
    if (played().user.count(offset) != 0) return {};
  }
  played().requested.insert(offsets.begin(), offsets.end());
  return LineRequest(std::shared_ptr<LineRequest::Lines>(
      new LineRequest::Lines{.offsets = {offsets.begin(), offsets.end()}}));
}

namespace {

constexpr int kEstopA = 16, kEstopB = 17, kDeadMan = 18, kEnable = 0, kHeartbeat = 1, kLed = 2,
              kScope = 3, kSync = 4, kGrip = 19, kClutch = 20, kEvent = 8;

class GpioWiring : public testing::Test {
 protected:
  GpioWiring() {
    played() = {};
    settings_.chip = "board";
    settings_.estop_a = kEstopA, settings_.estop_b = kEstopB, settings_.dead_man = kDeadMan;
    settings_.enable = kEnable, settings_.heartbeat = kHeartbeat;
    settings_.led = kLed, settings_.scope = kScope, settings_.grip = kGrip;
    settings_.clutch = kClutch, settings_.sync = kSync;
    for (int i = 0; i < 8; ++i) settings_.event.at(static_cast<std::size_t>(i)) = kEvent + i;
    for (const int input : {kEstopA, kEstopB, kDeadMan}) set(input, 1);
  }
  static void set(int offset, int level) {
    played().level.at(static_cast<std::size_t>(offset)) = level;
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

  LinesSettings settings_;
};

TEST_F(GpioWiring, ALineThatTheChipRefusesIsAnErrorAndNotAnUnwiredLine) {
  const std::array<std::pair<int, const char*>, 12> lines{{{kEstopA, "estop_a"},
                                                           {kEstopB, "estop_b"},
                                                           {kDeadMan, "dead_man"},
                                                           {kEnable, "enable"},
                                                           {kHeartbeat, "heartbeat"},
                                                           {kLed, "led"},
                                                           {kScope, "scope"},
                                                           {kGrip, "grip"},
                                                           {kClutch, "clutch"},
                                                           {kSync, "sync"},
                                                           {kEvent, "event_0"},
                                                           {kEvent + 7, "event_7"}}};
  for (const auto& [offset, key] : lines) {
    played().not_given = {offset};
    const auto opened = open();
    ASSERT_FALSE(opened) << key << " was taken for a line that is not wired";
    EXPECT_EQ(
        opened.error().message,
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
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ((*opened)->read(1'000'000), model::Fault::kNone);
    set(offset, 0);
    EXPECT_EQ((*opened)->read(2'000'000), fault) << "line " << offset;
    set(offset, 1);
  }
}

TEST_F(GpioWiring, TheGripLineClosesTheJawsAtTheLevelThatTheSceneSays) {
  for (const bool closes_low : {false, true}) {
    settings_.grip_closes_low = closes_low;
    const auto opened = open();
    ASSERT_TRUE(opened) << opened.error().message;
    std::int64_t now_ns = 0;
    const auto after_20ms = [&](int level) {
      set(kGrip, level);
      for (int i = 0; i < 20; ++i, now_ns += 1'000'000)
        EXPECT_EQ((*opened)->read(now_ns), model::Fault::kNone);
      return (*opened)->grip();
    };
    EXPECT_EQ(after_20ms(closes_low ? 1 : 0), false);
    EXPECT_EQ(after_20ms(closes_low ? 0 : 1), true);
    EXPECT_EQ(after_20ms(closes_low ? 1 : 0), false);
    (*opened)->stop();  // the chip does not answer: open, whichever level that is
    for (int i = 0; i < 20; ++i, now_ns += 1'000'000)
      EXPECT_EQ((*opened)->read(now_ns), model::Fault::kLinesLost);
    EXPECT_EQ((*opened)->grip(), false);
  }
}

TEST_F(GpioWiring, TheClutchIsPressedAfterItsLineWasHighFor10Ms) {
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().message;
  std::int64_t now_ns = 0;
  const auto after_ms = [&](int level, int ms) {
    set(kClutch, level);
    for (int i = 0; i < ms; ++i)
      EXPECT_EQ((*opened)->read(now_ns += 1'000'000), model::Fault::kNone);
    return (*opened)->clutch();
  };
  EXPECT_EQ(after_ms(0, 20), false);
  EXPECT_EQ(after_ms(1, 9), false) << "a contact bounces";
  EXPECT_EQ(after_ms(1, 2), true);
  EXPECT_EQ(after_ms(0, 20), false);
  EXPECT_EQ((*opened)->grip(), false) << "lines of their own";
}

TEST_F(GpioWiring, TheEventWordHasABitForEachOfItsLines) {
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().message;
  for (int i = 0; i < 8; ++i) {
    set(kEvent + i, 1);
    EXPECT_EQ((*opened)->read(1'000'000), model::Fault::kNone);
    EXPECT_EQ((*opened)->event_word(), 1 << i);
    set(kEvent + i, 0);
  }
  (*opened)->stop();
  EXPECT_EQ((*opened)->read(2'000'000), model::Fault::kLinesLost);
  EXPECT_EQ((*opened)->event_word(), 0);
}

TEST_F(GpioWiring, UnwiredLinesAreNeitherRequestedNorRead) {
  settings_.estop_a = settings_.estop_b = settings_.dead_man = settings_.grip = -1;
  settings_.clutch = settings_.sync = settings_.event[3] = -1;
  played().not_given = {kEstopA, kEstopB, kDeadMan, kGrip, kClutch, kSync, kEvent + 3};
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ((*opened)->read(1'000'000), model::Fault::kNone);
  EXPECT_FALSE((*opened)->grip());
  EXPECT_FALSE((*opened)->clutch());
  set(kEvent + 4, 1);
  EXPECT_EQ((*opened)->read(2'000'000), model::Fault::kNone);
  EXPECT_EQ((*opened)->event_word(), 16) << "of the lines that are wired";
}

TEST_F(GpioWiring, ALineInUseIsReportedWithItsUserAndTheOthersAreFreeAgain) {
  played().user = {{kHeartbeat, "lamp"}};
  const auto opened = open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message,
            "device.lines.heartbeat is line 1 of gpiochip0 \"board\", which lamp uses already; end "
            "it, or choose another line (gpioinfo gpiochip0 shows them)");
  EXPECT_TRUE(played().requested.empty());
  EXPECT_EQ(played().open, 0);
}

TEST_F(GpioWiring, OutputsAreLowAndAllLinesFreeAfterStop) {
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().message;
  (*opened)->scope(true);
  EXPECT_EQ((*opened)->write({.healthy = true, .armed = true, .sync = true}), model::Fault::kNone);
  for (const int output : {kHeartbeat, kLed, kScope, kSync})
    EXPECT_EQ(played().level.at(static_cast<std::size_t>(output)), 1) << "line " << output;
  EXPECT_EQ(played().requested.size(), 18u);
  (*opened)->stop();
  for (const int output : {kEnable, kHeartbeat, kLed, kScope, kSync})
    EXPECT_EQ(played().level.at(static_cast<std::size_t>(output)), 0) << "line " << output;
  EXPECT_TRUE(played().requested.empty());
  EXPECT_EQ((*opened)->read(2'000'000), model::Fault::kLinesLost);
}

}  // namespace
}  // namespace tact::hal::gpio
