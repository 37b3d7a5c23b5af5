// SPDX-License-Identifier: Apache-2.0
// list_devices.h - what is plugged into this PC, what each part lacks, and the remedy.
//
// Read from sysfs, so a running tactd is not disturbed. GPIO chips alone are opened, for a label:
//   class/net/*/type 280 (ARPHRD_CAN), flags bit 0 (IFF_UP)          CAN interfaces; bit rate by
//                                                                    netlink (can/can_link.h)
//   bus/usb/devices/*/idVendor idProduct busnum devnum, *:N/driver   devices by device_facts.h
//   .../tty/ttyACM*, .../hidraw/hidraw*                              what a PHANTOM is opened by
//   bus/gpio/devices/gpiochip*                                       GPIO chips (gpio/gpio_chips.h)
// Set-up code only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/can/can_link.h"
#include "hal/device_facts.h"
#include "hal/gpio/gpio_chips.h"

namespace tact::hal::list {

struct FoundPart {
  std::string kind;     // can, gpio, or as device.kind names it: falcon
  std::string name;     // can0, 1-2.3, gpiochip0
  std::string what;     // "CAN interface, up, 1000000 bit/s"
  std::string scene;    // the lines that name it: device.can.interface = "can0"
  std::string lacking;  // empty: ready
  std::string remedy;   // of what is lacking
};

/// How to look; others in tests.
struct PartProbes {
  gpio::SystemRoots roots{};
  std::vector<UsbPart> usb{};  // what to look for there: registry::usb_parts()
  /// errno of opening this node for reading and writing, 0 if it may be.
  int (*access_error)(const std::string& path) = nullptr;
  /// What the kernel knows of a CAN interface beyond sysfs: bit rate, state of the controller.
  std::optional<can::CanLink> (*can_link)(const std::string& interface) = nullptr;
};
PartProbes system_probes(std::vector<UsbPart> usb);

/// Everything that tact could use, by kind, then by name.
std::vector<FoundPart> list_devices(const PartProbes& probes);

/// What was looked for and how to get it to show up, of each kind of which nothing was found.
std::vector<std::string> absent_parts(const std::vector<FoundPart>& found,
                                      const std::vector<UsbPart>& usb);

}  // namespace tact::hal::list
