// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "firmware/run/lists.h"
#include "hal/registry/open_device.h"
#include "tests/support/program.h"

namespace tact::firmware::run::device_list_test {

using hal::list::FoundPart;

const std::vector<FoundPart> kParts{{.kind = "can",
                                     .name = "can0",
                                     .what = "CAN interface, down",
                                     .scene = "device.can.interface = \"can0\"",
                                     .lacking = "it is down",
                                     .remedy = "ip link set can0 up"},
                                    {.kind = "falcon",
                                     .name = "1-2",
                                     .what = "Novint Falcon",
                                     .scene = "device.kind = \"falcon\"",
                                     .lacking = "",
                                     .remedy = ""}};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DeviceList, ReportsWhatIsReadyWhatLacksAndWhatIsNotThere) {
  EXPECT_EQ(
      devices_as_text(kParts, hal::registry::usb_parts()),
      "can0: CAN interface, down\n"
      "  not ready: it is down\n"
      "  remedy: ip link set can0 up\n"
      "1-2: Novint Falcon\n"
      "  ready: device.kind = \"falcon\"\n"
      "no Force Dimension device (USB 1451:*); switch its supply on and plug in its cable "
      "(lsusb shows it)\n"
      "no PHANTOM or Touch on USB (2988:*); switch its supply on and plug in its cable (lsusb "
      "shows it); one on Ethernet or FireWire is not looked for\n"
      "no GPIO chip; load the driver of the board that has one (gpiodetect shows it)\n"
      "sim-delta: the simulated device\n"
      "  ready: device.kind = \"sim-delta\"\n");
}

TEST(DeviceList, TheJsonReportsTheSame) {
  const auto json = nlohmann::json::parse(devices_as_json(kParts));
  ASSERT_EQ(json["devices"].size(), 2u);
  EXPECT_EQ(json["devices"][0]["kind"], "can");
  EXPECT_EQ(json["devices"][0]["ready"], false);
  EXPECT_EQ(json["devices"][0]["remedy"], "ip link set can0 up");
  EXPECT_EQ(json["devices"][1]["kind"], "falcon");
  EXPECT_EQ(json["devices"][1]["ready"], true);
}

TEST(DeviceList, ADeviceMayCallItselfAnything) {
  auto parts = kParts;
  parts[1].what = "\xff\xfe \"quoted\"";
  EXPECT_TRUE(nlohmann::json::accept(devices_as_json(parts)));
}

TEST(DeviceList, TheOptionNeedsNoSceneAndNoDevice) {
  const auto text = tests::run_program("tactd", "--list-devices");
  EXPECT_EQ(text.status, 0) << text.output;
  EXPECT_TRUE(has(text.output, "sim-delta: the simulated device")) << text.output;
  const auto json = tests::run_program("tactd", "--list-devices --json -");
  EXPECT_EQ(json.status, 0);
  EXPECT_TRUE(nlohmann::json::accept(json.output)) << json.output;
}

TEST(DeviceList, AFileThatCannotBeWrittenIsNamed) {
  const auto outcome = tests::run_program("tactd", "--list-devices --json /nowhere/list.json");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(has(outcome.output, "/nowhere/list.json: cannot be written")) << outcome.output;
}

}  // namespace tact::firmware::run::device_list_test
