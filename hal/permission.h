// SPDX-License-Identifier: Apache-2.0
// permission.h - a device node that may not be opened: for a moment, or for lack of what.
//
// When a device is plugged in its node is root's alone, until udev has given it to the group: a
// refusal counts once it has lasted 200 ms. Its group then shows whether the rule is missing, or
// the member. Set-up code, which waits.
#pragma once

#include <sys/types.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "hal/device_facts.h"
#include "model/result.h"

namespace tact::hal {

/// `open` gives 0, EACCES when it is refused, or another error. The last that it gave.
template <class Open>
int open_when_permitted(Open open) {
  constexpr auto kPause = std::chrono::milliseconds(20);
  constexpr int kMaxTries = 11;  // 200 ms
  int error = open();
  for (int i = 1; i < kMaxTries && error == EACCES; ++i) {
    std::this_thread::sleep_for(kPause);
    error = open();
  }
  return error;
}

/// Why a part may not be used, and the remedy.
struct Refusal {
  std::string lacking, remedy;
  model::Error error(const char* between = "; ") const { return {lacking + between + remedy}; }
};

/// The group of the udev rules; none where it does not exist.
std::optional<gid_t> haptics_group();
/// The reason for a refused node; `rule` is that of its device.
Refusal why_refused(const std::string& node, const char* rule,
                    std::optional<gid_t> group = haptics_group());

/// 0, or the errno of opening a node for reading and writing; without opening it.
int access_error(const std::string& node);

/// Where the kernel shows devices; a test has others.
struct SystemRoots {
  std::string sys = "/sys";
  std::string dev = "/dev";
};
/// The first line of one of its files; empty when it cannot be read.
std::string first_line(const std::filesystem::path& file);
std::vector<std::filesystem::path> entries(const std::filesystem::path& folder);
/// By which node a USB device is opened: its serial port or HID node, else its own. `device` is its
/// folder in sysfs.
std::string usb_node(const std::filesystem::path& device, const SystemRoots& roots);
/// Which of these the device is, by its folder in sysfs; null: none.
const UsbPart* usb_part_of(const std::filesystem::path& device, std::span<const UsbPart> parts);
/// Why the first of these USB devices cannot be opened; nothing where all may be opened, or none
/// is there. For libraries that look for devices by themselves:
/// ask before the library, which then finds what udev has given away, and report only when it
/// fails, as it may open another device.
std::optional<Refusal> refused_usb_device(std::span<const UsbPart> parts,
                                          const SystemRoots& roots = {});

}  // namespace tact::hal
