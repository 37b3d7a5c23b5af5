// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/gpio_chips.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "hal/permission.h"

namespace tact::hal::gpio {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "gpiochip";
constexpr std::string_view kOwn = "gpio";  // of the chip itself
// Registers that the processor reads by itself. On every other bus a driver may have to wait.
constexpr std::array<std::string_view, 7> kFast{"pci", "pci_express", "platform", "acpi",
                                                "pnp", "isa",         "amba"};

bool is_fast(std::string_view bus) {
  return std::find(kFast.begin(), kFast.end(), bus) != kFast.end();
}

/// N of gpiochipN; -1 for other names.
int number_of(const std::string& name) {
  int number = -1;
  if (name.starts_with(kPrefix))
    std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
  return number;
}

/// Label and number of lines; the errno of opening stays, as the remedy depends on it.
void ask_chip(GpioChip& chip) {
  const int fd = open(chip.path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    chip.error = errno;
    return;
  }
  gpiochip_info info{};
  if (ioctl(fd, GPIO_GET_CHIPINFO_IOCTL, &info) == 0) {
    // The kernel need not end a full label with a zero.
    chip.label.assign(info.label, strnlen(info.label, sizeof info.label));
    chip.lines = static_cast<int>(info.lines);
  } else {
    chip.error = errno;
  }
  close(fd);
}

}  // namespace

std::string slow_bus(const std::string& device, const std::string& sys_root) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(sys_root, error);
  fs::path folder = fs::canonical(device, error);
  if (error) return kUnknownBus;
  bool known = false;
  // Up through every parent: a fast chip on a slow bus is slow.
  while (folder != root && folder.has_relative_path()) {
    const fs::path link = fs::read_symlink(folder / "subsystem", error);
    const std::string bus = error ? std::string() : link.filename().string();
    folder = folder.parent_path();
    if (bus.empty() || bus == kOwn) continue;
    if (!is_fast(bus)) return bus;
    known = true;
  }
  return known ? std::string() : kUnknownBus;
}

std::vector<GpioChip> find_gpio_chips(const SystemRoots& roots) {
  std::vector<GpioChip> chips;
  for (const fs::path& device : entries(roots.sys + "/bus/gpio/devices")) {
    const std::string name = device.filename().string();
    if (number_of(name) < 0) continue;
    GpioChip chip{.name = name, .path = roots.dev + "/" + name, .label = {}, .bus = {}};
    chip.bus = slow_bus(device.string(), roots.sys);
    ask_chip(chip);
    chips.push_back(std::move(chip));
  }
  std::sort(chips.begin(), chips.end(), [](const GpioChip& a, const GpioChip& b) {
    return number_of(a.name) < number_of(b.name);
  });
  return chips;
}

std::vector<GpioChip> find_permitted_chips(const SystemRoots& roots) {
  std::vector<GpioChip> chips;
  open_when_permitted([&] {
    chips = find_gpio_chips(roots);
    const auto refused = [](const GpioChip& chip) { return chip.error == EACCES; };
    return std::any_of(chips.begin(), chips.end(), refused) ? EACCES : 0;
  });
  return chips;
}

std::string name_chips(const std::vector<GpioChip>& chips) {
  std::string names;
  for (const GpioChip& chip : chips) {
    if (!names.empty()) names += ", ";
    names += chip.label.empty() ? chip.name : fmt::format("{} \"{}\"", chip.name, chip.label);
  }
  return names;
}

model::Error not_permitted(const GpioChip& chip) {
  return why_refused(chip.path, kGpioRule).error();
}

model::Result<GpioChip> choose_chip(const std::vector<GpioChip>& chips, const std::string& wanted) {
  std::error_code no_file;
  const std::string path = fs::weakly_canonical(wanted, no_file).string();  // a link
  const GpioChip* found = nullptr;
  const GpioChip* closed = nullptr;
  for (const GpioChip& chip : chips) {
    // Its label cannot be read, so it may be the one that is meant: the rights are then the remedy.
    if (chip.error != 0 && chip.bus.empty()) closed = &chip;
    if (path != chip.path && wanted != chip.label && wanted != chip.name) continue;
    if (found != nullptr)
      return model::Error{
          fmt::format("device.lines.chip \"{}\" fits {} and {}; name its path instead", wanted,
                      found->path, chip.path)};
    found = &chip;
  }
  if (found == nullptr && closed != nullptr) found = closed;  // its label could not be read
  if (found == nullptr)
    return model::Error{fmt::format(
        "device.lines.chip is \"{}\", but {}; load the driver of the board that the lines are "
        "wired to, or correct the name",
        wanted,
        chips.empty() ? "this PC shows no GPIO chip" : "here are only " + name_chips(chips))};
  if (!found->bus.empty())
    return model::Error{fmt::format(
        "{} \"{}\" hangs on {}, where an access may wait for milliseconds: it cannot carry safety "
        "lines; use a chip on PCI, LPC or the processor itself",
        found->name, found->label, found->bus)};
  if (found->error == EACCES || found->error == EPERM) return not_permitted(*found);
  if (found->error != 0)
    return model::Error{fmt::format("{} cannot be opened: {}; check its driver (dmesg)",
                                    found->path, std::strerror(found->error))};
  return *found;
}

}  // namespace tact::hal::gpio
