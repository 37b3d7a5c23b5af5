// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_usb.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "hal/falcon/falcon_device.h"
#include "hal/falcon_usb/falcon_open.h"
#include "hal/permission.h"
#include "hal/registry/open_device.h"
#include "tests/hal/falcon_usb/fake_libusb.h"

namespace tact::hal::falcon_usb::falcon_usb_test {

class FalconUsbTest : public testing::Test {
 protected:
  FalconUsbTest() { tests::fake_usb = &usb; }
  ~FalconUsbTest() override {
    EXPECT_EQ(usb.contexts, 0);  // everything was given back
    EXPECT_EQ(usb.handles, 0);
    EXPECT_EQ(usb.lists, 0);
    EXPECT_EQ(usb.claims, 0);
    tests::fake_usb = nullptr;
  }
  static std::string refusal(const std::string& bus_path = "") {
    const auto opened = FalconUsb::open(bus_path);
    EXPECT_FALSE(opened);
    return opened ? "" : opened.error().message;
  }
  void expect_refusal(const std::vector<std::string>& words, const std::string& bus_path = "") {
    const std::string message = refusal(bus_path);
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
  }
  tests::FakeUsb usb;
};

TEST_F(FalconUsbTest, OpensTheOnlyFalconAmongOtherDevices) {
  usb.plugs = {{.vendor = 0x1d6b, .product = 2, .address = 1, .ports = {}},
               {.product = 0x6001, .address = 3},
               {.address = 7}};
  const auto opened = FalconUsb::open("");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ((*opened)->bus_path(), "1-2.3");
  EXPECT_EQ((*opened)->node(), "/dev/bus/usb/001/007");
  EXPECT_EQ(usb.detach, 0);  // no driver comes back before usbfs takes over
}

TEST_F(FalconUsbTest, MissingFalconIsReportedWithItsUsbIdentifier) {
  usb.plugs = {{.product = 0x6001}};
  expect_refusal({"0403:cb48", "plug in"});
}

TEST_F(FalconUsbTest, SeveralNeedABusPath) {
  usb.plugs = {{}, {.bus = 2, .address = 9, .ports = {1}}};
  expect_refusal({"1-2.3, 2-1", "device.falcon.bus_path"});
  expect_refusal({"\"3-4\"", "1-2.3, 2-1"}, "3-4");
  const auto second = FalconUsb::open("2-1");
  ASSERT_TRUE(second);
  EXPECT_EQ((*second)->node(), "/dev/bus/usb/002/009");
}

TEST_F(FalconUsbTest, WithoutPermissionTheRuleAndItsRemedyAreNamed) {
  usb.open_error = LIBUSB_ERROR_ACCESS;
  expect_refusal({falcon::kFalconParts[0].rule, "/dev/bus/usb/001/004",
                  why_refused("/dev/bus/usb/001/004", "").remedy});
}

TEST_F(FalconUsbTest, ARefusalThatUdevEndsIsNotReported) {
  usb.open_error = LIBUSB_ERROR_ACCESS;
  usb.refused_opens = 5;
  const auto opened = FalconUsb::open("");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(usb.opens, 6);
}

TEST_F(FalconUsbTest, AnErrorThatIsNoRefusalIsReportedAtOnce) {
  usb.open_error = LIBUSB_ERROR_NO_DEVICE;
  expect_refusal({"cannot be opened"});
  EXPECT_EQ(usb.opens, 1);
}

TEST_F(FalconUsbTest, AnotherProgramIsDistinguishedFromAKernelDriver) {
  usb.claim_error = LIBUSB_ERROR_BUSY;
  expect_refusal({"another program", "fuser /dev/bus/usb/001/004"});
  usb.driver_active = 1;
  expect_refusal({"kernel driver", "rmmod ftdi_sio"});
}

TEST_F(FalconUsbTest, IsLockedByItsPathBeforeItIsOpened) {
  usb.another_has_it = true;
  usb.open_error = LIBUSB_ERROR_BUSY;
  expect_refusal({"the Falcon at USB 1-2.3", "process 7"});
}

TEST_F(FalconUsbTest, UnpluggedDeviceIsReportedWithTheRemedy) {
  usb.open_error = LIBUSB_ERROR_NO_DEVICE;
  expect_refusal({"cannot be opened", "plug it in again"});
  usb.open_error = 0;
  usb.claim_error = LIBUSB_ERROR_NO_DEVICE;
  expect_refusal({"cannot be claimed", "plug it in again"});
}

TEST_F(FalconUsbTest, AColdFalconIsSentItsImageAndItsChipSetUp) {
  const tests::Bytes image(200, 0xAA);
  for (const bool event_character : {true, false}) {
    usb.falcon = {.null_first = true, .image_size = image.size()};
    auto opened = FalconUsb::open("");
    ASSERT_TRUE(opened);
    const auto boot = boot_falcon(*opened, image, event_character);
    ASSERT_TRUE(boot) << boot.error().message;
    EXPECT_TRUE(boot->uploaded());
    EXPECT_EQ(usb.falcon.received, image);
    EXPECT_EQ(usb.controls.back(),
              event_character ? falcon::ftdi_event_character(0x3E) : falcon::ftdi_request(6, 0));
  }
}

TEST_F(FalconUsbTest, ARunningFalconIsOnlyAsked) {
  auto opened = FalconUsb::open("");
  ASSERT_TRUE(opened);
  const auto boot = boot_falcon(*opened, {}, true);
  ASSERT_TRUE(boot);
  EXPECT_FALSE(boot->uploaded());
}

TEST_F(FalconUsbTest, AFailedUploadIsOpenedAndTriedAgain) {
  const tests::Bytes image(200, 0x55);
  usb.falcon = {.spoiled_echoes = 1, .image_size = image.size()};
  auto opened = FalconUsb::open("");
  ASSERT_TRUE(opened);
  const auto boot = boot_falcon(*opened, image, true);
  ASSERT_TRUE(boot) << boot.error().message;
  EXPECT_EQ(boot->attempt(), 2);
}

TEST_F(FalconUsbTest, GivingUpSaysWhatToDo) {
  usb.falcon.runs = false;
  usb.falcon.in_rom = true;
  auto opened = FalconUsb::open("");
  ASSERT_TRUE(opened);
  auto boot = boot_falcon(*opened, {}, true);
  ASSERT_FALSE(boot);
  EXPECT_EQ(boot.error().message, falcon_boot_advice(falcon::FalconBootFault::kNoImage));
  usb.control_error = LIBUSB_ERROR_PIPE;
  boot = boot_falcon(*opened, {}, true);
  ASSERT_FALSE(boot);
  EXPECT_EQ(boot.error().message, falcon_boot_advice(falcon::FalconBootFault::kTransport));
}

TEST_F(FalconUsbTest, AFirmwareFileMustBeThereAndKnown) {
  const auto none = load_falcon_image("", "");
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
  const auto missing = load_falcon_image("/nowhere/nvent.bin", "");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("/nowhere/nvent.bin"), std::string::npos);
  EXPECT_NE(missing.error().message.find("device.falcon.firmware"), std::string::npos);
  const std::string path =
      testing::TempDir() + "tact-falcon-image-" + std::to_string(getpid()) + ".bin";
  std::ofstream(path) << "no firmware";
  const auto unknown = load_falcon_image(path, "");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find(path), std::string::npos);
  const auto named = load_falcon_image(  // sha256sum of "no firmware"
      path, "b5316af67c9a59b645c65b8729080d4b1d35d8dffaba772ca23cc30b2850c956");
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->size(), 11u);
  unlink(path.c_str());
}

TEST_F(FalconUsbTest, ErrorMessageBeginsWithTheSceneFile) {
  usb.plugs.clear();
  model::scene::Scene scene;
  scene.path = "liver.toml";
  scene.device.kind = "falcon";
  const auto device = registry::open_device(scene);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message.find("liver.toml: no Novint Falcon"), 0u)
      << device.error().message;
}

TEST_F(FalconUsbTest, UsbfsTakesOverOnlyWhenLibusbHasLetGo) {
  falcon::FalconSettings settings;  // the node of the fake does not exist
  const auto device = falcon_usb::open_falcon_device(settings);
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("/dev/bus/usb/001/004"), std::string::npos);
  EXPECT_EQ(usb.handles, 0);
}

}  // namespace tact::hal::falcon_usb::falcon_usb_test
