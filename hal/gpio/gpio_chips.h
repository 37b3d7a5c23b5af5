// SPDX-License-Identifier: Apache-2.0
// gpio_chips.h - the GPIO chips of this PC, and which of them a loop may not wait for (GP-3).
//
// A chip behind USB, I2C, SPI or a virtual machine's queue answers after milliseconds and its
// driver sleeps meanwhile; the kernel knows (can_sleep) but does not report it to user space, so
// the buses above the chip are read from sysfs: /sys/bus/gpio/devices/gpiochipN and the `subsystem`
// links of its parents. All of them must be known to be fast: PCI, platform, ACPI, PnP, ISA, AMBA.
// A platform driver that passes accesses on to another chip (gpio-aggregator) is not seen through.
// Label and number of lines come from the chip itself (linux/gpio.h, GPIO_GET_CHIPINFO_IOCTL).
// Set-up only.
#pragma once

#include <string>
#include <vector>

#include "hal/permission.h"
#include "model/result.h"

namespace tact::hal::gpio {

using hal::SystemRoots;

inline constexpr const char* kGpioRule =
    R"(SUBSYSTEM=="gpio", KERNEL=="gpiochip[0-9]*", GROUP="haptics", MODE="0660")";

struct GpioChip {
  std::string name;   // gpiochip0
  std::string path;   // /dev/gpiochip0
  std::string label;  // of its driver; empty when it may not be opened
  int lines = -1;     // -1: not known
  std::string bus;    // of the slow or unknown bus it hangs on, as "usb"; empty: it is fast
  int error = 0;      // errno of opening it
};

/// All chips, by number.
std::vector<GpioChip> find_gpio_chips(const SystemRoots& roots = {});
/// The same; one that is refused is asked again for 200 ms (hal/permission.h).
std::vector<GpioChip> find_permitted_chips(const SystemRoots& roots);

/// What is there, for a message: `gpiochip0 "pinctrl-intel", gpiochip1 "mcp2221"`.
std::string name_chips(const std::vector<GpioChip>& chips);

/// The chip that is meant: by path, label or name, and on no bus where every access sleeps.
model::Result<GpioChip> choose_chip(const std::vector<GpioChip>& chips, const std::string& wanted);

/// The chip is there, and may not be opened.
model::Error not_permitted(const GpioChip& chip);

inline constexpr const char* kUnknownBus = "an unknown bus";

/// The first subsystem above `device` (a folder of sysfs) that is not known to be fast; kUnknownBus
/// when there is none at all; nothing when all are fast.
std::string slow_bus(const std::string& device, const std::string& sys_root);

}  // namespace tact::hal::gpio
