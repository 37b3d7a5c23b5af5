// SPDX-License-Identifier: Apache-2.0
#include "hal/permission.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "hal/rights_remedy.h"
#include "tests/support/usb_folders.h"

namespace tact::hal::permission_test {

constexpr const char* kRule = "SUBSYSTEM==\"haptics\"";

TEST(Permission, RefusalThatUdevEndsWithin200MsIsRetried) {
  int opens = 0;
  EXPECT_EQ(open_when_permitted([&] { return ++opens < 8 ? EACCES : 0; }), 0);
  EXPECT_EQ(opens, 8);
}

TEST(Permission, LastingRefusalIsReportedAndOtherErrorsAreNotRetried) {
  int opens = 0;
  EXPECT_EQ(open_when_permitted([&] { return ++opens, EACCES; }), EACCES);
  EXPECT_EQ(opens, 11);
  opens = 0;
  EXPECT_EQ(open_when_permitted([&] { return ++opens, ENODEV; }), ENODEV);
  EXPECT_EQ(opens, 1);
}

class PermissionOfNode : public testing::Test {
 protected:
  tests::UsbFolders usb{"1451", "0402"};
  const std::string& node = usb.node;
};

TEST_F(PermissionOfNode, TheRuleIsMissingUnlessTheNodeIsOfTheGroup) {
  const gid_t own = getegid();
  const Refusal of_root = why_refused(node, kRule, own + 1);
  EXPECT_NE(of_root.lacking.find(kRule), std::string::npos) << of_root.lacking;
  EXPECT_EQ(
      of_root.remedy,
      hal::container_of() == nullptr
          ? hal::group_remedy() + " installs it; then sudo adduser $USER haptics, and log in again"
          : "start the container with --device " + node);
  const Refusal of_group = why_refused(node, kRule, own);
  EXPECT_EQ(of_group.lacking.find("rule"), std::string::npos) << of_group.lacking;
  EXPECT_NE(of_group.lacking.find("group haptics"), std::string::npos);
  EXPECT_EQ(of_group.remedy, "sudo adduser $USER haptics, and log in again");
  EXPECT_NE(why_refused(node, kRule, std::nullopt).lacking.find("rule"), std::string::npos);
  chmod(node.c_str(), 0640);
  EXPECT_NE(why_refused(node, kRule, own).lacking.find("rule is missing"), std::string::npos);
}

TEST_F(PermissionOfNode, AUsbDeviceThatALibraryLooksForIsRefusedByItsNodeAlone) {
  const auto ask = [&](const char* vendor, const char* product) {
    const UsbPart part{.kind = "", .vendor = vendor, .product = product, .name = "", .rule = kRule};
    return refused_usb_device({&part, 1}, usb.roots());
  };
  EXPECT_FALSE(ask("1451", nullptr)) << "it may be opened";
  EXPECT_FALSE(ask("2988", nullptr)) << "it is not there";
  const auto see_refusal = [&] {
    chmod(node.c_str(), 0);
    tests::drop_privileges();
    const auto refusal = ask("1451", "0402");
    const bool reported = refusal && refusal->lacking.starts_with(node + " may not be opened");
    _exit(reported && !ask("1451", "0403") ? 7 : 8);
  };
  EXPECT_EXIT(see_refusal(), testing::ExitedWithCode(7), "");
}

TEST(Permission, ADeviceWithASerialPortIsJudgedByThatPortAlone) {
  const tests::UsbFolders usb("2988", "0302");
  const std::string port = usb.root + "/dev/ttyACM0";
  std::filesystem::create_directories(usb.device + "/1-2:1.0/tty/ttyACM0");
  const auto see_refusals = [&] {
    usb.add_node(usb.node, 0);
    usb.add_node(port, 0666);
    tests::drop_privileges();
    const UsbPart part{.kind = "", .vendor = "2988", .name = "", .rule = kRule};
    _exit(refused_usb_device({&part, 1}, usb.roots()) ? 8 : 7);
  };
  EXPECT_EXIT(see_refusals(), testing::ExitedWithCode(7), "");
  EXPECT_EQ(usb_node(usb.device, usb.roots()), port);
}

}  // namespace tact::hal::permission_test
