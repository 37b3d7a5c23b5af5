// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/gpio_lines.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "hal/gpio/edge_monitor.h"
#include "hal/lines_settings.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::gpio::gpio_lines_test {

namespace fs = std::filesystem;

/// A sysfs with the chips that a test names, in a folder of its own.
class Sysfs : public testing::Test {
 protected:
  Sysfs()
      : root_(testing::TempDir() + "tact-gpio-" + std::to_string(getpid()) + "-" +
              testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(root_);
    fs::create_directories(root_ + "/sys/bus/gpio/devices");
    fs::create_directories(root_ + "/dev");
  }
  ~Sysfs() override { fs::remove_all(root_); }

  /// `parents`: subsystem of each folder from the outermost to the chip's parent; "" has none.
  void chip(int number, const std::vector<std::string>& parents) {
    std::string folder = root_ + "/sys/devices";
    for (const std::string& subsystem : parents) {
      folder += "/d-" + (subsystem.empty() ? "plain" : subsystem);
      fs::create_directories(folder);
      link(folder, subsystem);
    }
    const std::string name = "gpiochip" + std::to_string(number);
    folder += "/" + name;
    fs::create_directories(folder);
    link(folder, "gpio");
    fs::create_directory_symlink(folder, root_ + "/sys/bus/gpio/devices/" + name);
    std::ofstream(root_ + "/dev/" + name) << "no chip";
  }
  SystemRoots roots() const { return {.sys = root_ + "/sys", .dev = root_ + "/dev"}; }

 private:
  void link(const std::string& folder, const std::string& subsystem) const {
    if (subsystem.empty()) return;
    fs::create_directories(root_ + "/sys/bus/" + subsystem);
    fs::remove(folder + "/subsystem");
    fs::create_directory_symlink(root_ + "/sys/bus/" + subsystem, folder + "/subsystem");
  }
  std::string root_;
};

GpioChip board() {
  return {.name = "gpiochip0",
          .path = "/dev/gpiochip0",
          .label = "pci-idio-16",
          .lines = 32,
          .bus = {},
          .error = 0};
}
LinesSettings wired() {
  LinesSettings lines;
  lines.chip = "pci-idio-16";
  lines.estop_a = 16, lines.estop_b = 17, lines.enable = 0, lines.heartbeat = 1;
  return lines;
}
std::string refusal(const std::vector<GpioChip>& chips, const std::string& wanted) {
  const auto chip = choose_chip(chips, wanted);
  return chip ? "" : chip.error().message;
}
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Sysfs, AChipBehindASlowBusSleepsHoweverFarAbove) {
  chip(0, {"pci"});
  chip(1, {"pci", "usb", "usb", "hid"});
  chip(2, {"pci", "platform", "i2c", "i2c"});
  chip(3, {"platform", "", "spi"});
  chip(10, {"platform"});
  const auto chips = find_gpio_chips(roots());
  ASSERT_EQ(chips.size(), 5u);
  EXPECT_EQ(chips[0].bus, "");
  EXPECT_EQ(chips[1].bus, "hid");
  EXPECT_EQ(chips[2].bus, "i2c");
  EXPECT_EQ(chips[3].bus, "spi");
  EXPECT_EQ(chips[4].name, "gpiochip10") << "by number, not by letter";
  EXPECT_EQ(chips[4].bus, "");
}

TEST_F(Sysfs, ABusThatIsNotKnownToBeFastIsTakenForSlow) {
  chip(0, {"pci", "virtio"});
  chip(1, {});
  chip(2, {"", ""});
  chip(3, {"pci", "pci_express", "", "pnp"});
  chip(4, {"acpi", "platform", "isa"});
  chip(5, {"platform", "amba"});
  const auto chips = find_gpio_chips(roots());
  ASSERT_EQ(chips.size(), 6u);
  EXPECT_EQ(chips[0].bus, "virtio");
  EXPECT_EQ(chips[1].bus, kUnknownBus);
  EXPECT_EQ(chips[2].bus, kUnknownBus);
  for (const std::size_t fast : {3u, 4u, 5u}) EXPECT_EQ(chips[fast].bus, "") << chips[fast].name;
  EXPECT_TRUE(has(refusal(chips, "gpiochip0"), "hangs on virtio"));
  EXPECT_EQ(slow_bus(roots().sys + "/no/such/folder", roots().sys), kUnknownBus);
}

TEST_F(Sysfs, AChipThatDoesNotAnswerIsNamedWithItsPath) {
  chip(0, {"pci"});
  auto lines = wired();
  lines.chip = "gpiochip0";
  const auto opened = open_safety_lines(lines, roots());
  ASSERT_FALSE(opened);
  EXPECT_TRUE(has(opened.error().message, roots().dev + "/gpiochip0 cannot be opened"))
      << opened.error().message;
}

TEST_F(Sysfs, ARefusedChipIsAskedAgainFor200Ms) {
  chip(0, {"pci"});
  const auto see_refusal = [this] {
    constexpr uid_t kOther = 65534;
    fs::permissions(roots().dev + "/gpiochip0", fs::perms::none);
    if (geteuid() == 0 && setreuid(kOther, kOther) != 0) _exit(2);  // root may open any node
    const auto begun = std::chrono::steady_clock::now();
    const auto lines = open_safety_lines(wired(), roots());
    const bool waited = std::chrono::steady_clock::now() - begun >= std::chrono::milliseconds(200);
    const bool reported = !lines && lines.error().message.find(kGpioRule) != std::string::npos;
    _exit(waited && reported ? 7 : 8);
  };
  EXPECT_EXIT(see_refusal(), testing::ExitedWithCode(7), "");
}

TEST_F(Sysfs, ASleepingChipIsRefusedBeforeItIsOpened) {
  chip(0, {"pci", "usb"});
  auto lines = wired();
  lines.chip = roots().dev + "/gpiochip0";
  const auto opened = open_safety_lines(lines, roots());
  ASSERT_FALSE(opened);
  EXPECT_TRUE(has(opened.error().message, "hangs on usb")) << opened.error().message;
  EXPECT_TRUE(has(opened.error().message, "use a chip on PCI")) << opened.error().message;
}

TEST_F(Sysfs, PcWithoutGpioChipsIsReported) {
  const auto opened = open_safety_lines(wired(), roots());
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message,
            "device.lines.chip is \"pci-idio-16\", but this PC shows no GPIO chip; load the driver "
            "of the board that the lines are wired to, or correct the name");
}

TEST_F(Sysfs, EdgesAreWatchedUnderTheSameRulesAsSafetyLines) {
  const auto none = open_edge_monitor("board", 3, "a test", roots());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no GPIO chip"), std::string::npos);
  chip(0, {"platform", "usb"});
  const auto slow = open_edge_monitor("gpiochip0", 3, "a test", roots());
  ASSERT_FALSE(slow);
  EXPECT_NE(slow.error().message.find("hangs on usb"), std::string::npos);
}

TEST_F(Sysfs, SceneWithoutAChipIsEnabledWithoutLines) {
  const auto lines = open_safety_lines({}, roots());
  ASSERT_TRUE(lines);
  EXPECT_EQ((*lines)->read(0), model::Fault::kNone);
  EXPECT_TRUE((*lines)->enabled());
}

TEST(GpioLines, AChipIsFoundByLabelNameOrPath) {
  for (const char* wanted : {"pci-idio-16", "gpiochip0", "/dev/gpiochip0"}) {
    const auto chip = choose_chip({board()}, wanted);
    ASSERT_TRUE(chip) << wanted << ": " << chip.error().message;
    EXPECT_EQ(chip->path, "/dev/gpiochip0");
  }
}

TEST(GpioLines, AMissingChipListsThoseThatAreHere) {
  EXPECT_TRUE(has(refusal({board()}, "rig-gpio"), "here are only gpiochip0 \"pci-idio-16\""));
}

TEST(GpioLines, TwoChipsOfOneLabelAreDistinguishedByPath) {
  GpioChip second = board();
  second.name = "gpiochip1", second.path = "/dev/gpiochip1";
  EXPECT_TRUE(has(refusal({board(), second}, "pci-idio-16"), "fits /dev/gpiochip0 and"));
  EXPECT_EQ(refusal({board(), second}, "/dev/gpiochip1"), "");
}

TEST(GpioLines, AMissingPermissionPrintsTheRule) {
  GpioChip closed = board();
  closed.error = EACCES, closed.label = "", closed.lines = -1;
  EXPECT_TRUE(has(refusal({closed}, "gpiochip0"), kGpioRule));
  EXPECT_TRUE(has(refusal({closed}, "pci-idio-16"), kGpioRule)) << "its label cannot be read";
}

TEST(GpioLines, LineNumbersAreCheckedAgainstTheChip) {
  EXPECT_TRUE(check_offsets(wired(), board()));
  auto lines = wired();
  lines.enable = 32;
  EXPECT_EQ(check_offsets(lines, board()).error().message,
            "device.lines.enable is 32, but gpiochip0 \"pci-idio-16\" has lines 0 to 31");
  lines = wired();
  lines.led = lines.estop_b;
  EXPECT_EQ(check_offsets(lines, board()).error().message,
            "device.lines.estop_b and led are both line 17; give each its own");
  lines = {};
  lines.chip = "pci-idio-16";
  EXPECT_TRUE(has(check_offsets(lines, board()).error().message, "no line of it"));
}

}  // namespace tact::hal::gpio::gpio_lines_test
