// SPDX-License-Identifier: Apache-2.0
#include "hal/list/list_devices.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "hal/falcon/falcon_device.h"
#include "hal/force_dimension/force_dimension_device.h"
#include "hal/phantom/phantom_device.h"
#include "hal/registry/open_device.h"

namespace tact::hal::list::list_devices_test {

namespace fs = std::filesystem;

int all_may(const std::string&) { return 0; }
int deny_all(const std::string&) { return EACCES; }
int gone(const std::string&) { return ENOENT; }
std::optional<can::CanLink> half_speed(const std::string&) {
  return can::CanLink{
      .is_can = true, .up = true, .bitrate = 500'000, .state = {}, .restart_ms = {}};
}
std::optional<can::CanLink> bus_off(const std::string&) {
  return can::CanLink{.is_can = true,
                      .up = true,
                      .bitrate = 1'000'000,
                      .state = can::CanLinkState::kBusOff,
                      .restart_ms = {}};
}
std::optional<can::CanLink> unknown(const std::string&) { return std::nullopt; }

/// A sysfs that a test fills, in a folder of its own.
class ListDevices : public testing::Test {
 protected:
  ListDevices()
      : root_(testing::TempDir() + "tact-list-" + std::to_string(getpid()) + "-" +
              testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(root_);
    fs::create_directories(root_ + "/sys");
    probes.roots = {.sys = root_ + "/sys", .dev = root_ + "/dev"};
    probes.usb = registry::usb_parts();
    probes.access_error = all_may;
  }
  ~ListDevices() override { fs::remove_all(root_); }

  void file(const std::string& path, const std::string& content) const {
    fs::create_directories(fs::path(root_ + path).parent_path());
    std::ofstream(root_ + path) << content << '\n';
  }
  void net(const std::string& name, int type, const std::string& flags) const {
    file("/sys/class/net/" + name + "/type", std::to_string(type));
    file("/sys/class/net/" + name + "/flags", flags);
  }
  void usb(const std::string& name, const std::string& vendor, const std::string& product,
           const std::string& driver = "") const {
    const std::string folder = "/sys/bus/usb/devices/" + name;
    file(folder + "/idVendor", vendor);
    file(folder + "/idProduct", product);
    file(folder + "/busnum", "1");
    file(folder + "/devnum", "7");
    file(folder + "/product", "omega.x haptic device");
    const std::string interface = folder + "/" + name + ":1.0";
    fs::create_directories(root_ + interface);
    if (!driver.empty())
      fs::create_directory_symlink("../../../drivers/" + driver, root_ + interface + "/driver");
  }
  FoundPart only() const {
    const auto parts = list_devices(probes);
    EXPECT_EQ(parts.size(), 1u);
    return parts.empty() ? FoundPart{} : parts.front();
  }

  std::string root_;
  PartProbes probes;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(ListDevices, AnEmptyPcIsAnEmptyList) { EXPECT_TRUE(list_devices(probes).empty()); }

TEST_F(ListDevices, OnlyCanInterfacesAreCan) {
  net("eth0", 1, "0x1003");
  net("can0", 280, "0x40081");
  const FoundPart part = only();
  EXPECT_EQ(part.name, "can0");
  EXPECT_EQ(part.what, "CAN interface, up");
  EXPECT_EQ(part.lacking, "");
  EXPECT_TRUE(has(part.scene, "device.can.interface = \"can0\""));
}

TEST_F(ListDevices, ABitRateIsShownWhereItIsKnown) {
  net("can0", 280, "0x40081");
  probes.can_link = half_speed;
  EXPECT_EQ(only().what, "CAN interface, up, 500000 bit/s");
  probes.can_link = unknown;
  EXPECT_EQ(only().what, "CAN interface, up");
}

TEST_F(ListDevices, AnInterfaceThatIsDownHasTheCommand) {
  net("can1", 280, "0x40080");
  EXPECT_EQ(only().lacking, "can1 is down");
  EXPECT_TRUE(has(only().remedy, "sudo ip link set can1 up type can bitrate 1000000"))
      << only().remedy;
}

TEST_F(ListDevices, ABusThatIsOffIsNotReadyThoughItsInterfaceIsUp) {
  net("can0", 280, "0x40081");
  probes.can_link = bus_off;
  EXPECT_EQ(only().lacking, "can0 is bus-off");
  EXPECT_TRUE(has(only().remedy, "check bit rate")) << only().remedy;
}

TEST_F(ListDevices, AFalconIsFoundAmongOtherFtdiAdapters) {
  usb("1-1", "0403", "6001", "ftdi_sio");
  usb("1-2.3", "0403", "cb48");
  const FoundPart part = only();
  EXPECT_EQ(part.kind, "falcon");
  EXPECT_EQ(part.what, "Novint Falcon, USB 0403:cb48");
  EXPECT_EQ(part.scene, "device.kind = \"falcon\", device.falcon.bus_path = \"1-2.3\"");
  EXPECT_EQ(part.lacking, "");
}

TEST_F(ListDevices, AKernelDriverOnTheFalconIsNamedWithTheCommandThatUnbindsIt) {
  usb("1-2", "0403", "cb48", "ftdi_sio");
  EXPECT_EQ(only().lacking, "the kernel driver ftdi_sio holds it");
  EXPECT_EQ(only().remedy, "echo 1-2:1.0 | sudo tee /sys/bus/usb/drivers/ftdi_sio/unbind");
}

TEST_F(ListDevices, ADeviceInUseIsNotReady) {
  usb("1-2", "0403", "cb48", "usbfs");
  EXPECT_EQ(only().lacking, "another program uses it");
}

TEST_F(ListDevices, ForceDimensionDeviceIsShownWithItsProductName) {
  usb("2-1", "1451", "0402");
  const FoundPart part = only();
  EXPECT_EQ(part.kind, "force-dimension");
  EXPECT_EQ(part.what, "Force Dimension device \"omega.x haptic device\", USB 1451:0402");
}

TEST_F(ListDevices, APhantomIsFoundByItsSerialPortOrItsHidNode) {
  probes.access_error = deny_all;
  const struct {
    const char *vendor, *product, *inside, *node, *rule;
  } cases[] = {
      {"2988", "0302", "1-2:1.0/tty/ttyACM0", "/dev/ttyACM0", phantom::kPhantomParts[0].rule},
      {"2988", "0304", "1-2:1.0/0003:2988:0304.0001/hidraw/hidraw3", "/dev/hidraw3",
       phantom::kPhantomParts[0].rule},
      {"0301", "2988", "1-2:1.1/power", "/dev/bus/usb/001/007", phantom::kPhantomParts[1].rule}};
  for (const auto& c : cases) {
    fs::remove_all(root_ + "/sys/bus");
    usb("1-2", c.vendor, c.product, "cdc_acm");
    fs::create_directories(root_ + "/sys/bus/usb/devices/1-2/" + c.inside);
    const FoundPart part = only();
    EXPECT_EQ(part.kind, "phantom");
    EXPECT_EQ(part.what, std::string("PHANTOM \"omega.x haptic device\", USB ") + c.vendor + ":" +
                             c.product + ", bound to cdc_acm");
    EXPECT_EQ(part.scene, "device.kind = \"phantom\"");
    EXPECT_TRUE(has(part.lacking, root_ + c.node + " may not be opened")) << part.lacking;
    EXPECT_TRUE(has(part.lacking, c.rule)) << part.lacking;
  }
  usb("1-2", "0301", "0001");
  EXPECT_TRUE(list_devices(probes).empty()) << "another device of that vendor number";
}

TEST_F(ListDevices, AMissingPermissionPrintsTheRuleOfThatDevice) {
  probes.access_error = deny_all;
  usb("1-2", "0403", "cb48");
  EXPECT_TRUE(has(only().lacking, falcon::kFalconParts[0].rule));
  EXPECT_TRUE(has(only().lacking, "/dev/bus/usb/001/007"));
  EXPECT_EQ(only().remedy, why_refused(root_ + "/dev/bus/usb/001/007", "").remedy);
  usb("1-2", "1451", "0402");
  EXPECT_TRUE(has(only().lacking, force_dimension::kForceDimensionParts[0].rule));
}

TEST_F(ListDevices, MissingDeviceNodeIsNotBlamedOnUdevRules) {
  probes.access_error = gone;
  usb("1-2", "0403", "cb48");
  EXPECT_FALSE(has(only().lacking, "udev"));
  EXPECT_TRUE(has(only().lacking, "No such file"));
}

TEST_F(ListDevices, AGpioChipOnUsbIsShownAsNoGoodForSafety) {
  const std::string chip = root_ + "/sys/devices/usb1/gpiochip3";
  fs::create_directories(chip);
  fs::create_directories(root_ + "/sys/bus/gpio/devices");
  fs::create_directories(root_ + "/sys/bus/usb");
  fs::create_directory_symlink(root_ + "/sys/bus/usb", root_ + "/sys/devices/usb1/subsystem");
  fs::create_directory_symlink(chip, root_ + "/sys/bus/gpio/devices/gpiochip3");
  EXPECT_EQ(only().what, "GPIO chip, may sleep (on usb)");
  EXPECT_TRUE(has(only().lacking, "cannot carry safety lines"));
}

}  // namespace tact::hal::list::list_devices_test
