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
#include <filesystem>
#include <string_view>

namespace tact::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "gpiochip";
constexpr std::array<std::string_view, 9> kSleeping{"usb",  "hid",    "i2c",     "i3c",     "spi",
                                                    "spmi", "serial", "greybus", "mdio_bus"};

/// N of gpiochipN; -1 for other names.
int number_of(const std::string& name) {
  int number = -1;
  if (name.starts_with(kPrefix))
    std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
  return number;
}

void ask_chip(GpioChip& chip) {
  const int fd = open(chip.path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    chip.error = errno;
    return;
  }
  gpiochip_info info{};
  if (ioctl(fd, GPIO_GET_CHIPINFO_IOCTL, &info) == 0) {
    chip.label.assign(info.label, strnlen(info.label, sizeof info.label));
    chip.lines = static_cast<int>(info.lines);
  } else {
    chip.error = errno;
  }
  close(fd);
}

}  // namespace

std::string sleeping_bus(const std::string& device, const std::string& sys_root) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(sys_root, error);
  fs::path folder = fs::canonical(device, error);
  if (error) return {};
  while (folder != root && folder.has_relative_path()) {
    const fs::path link = fs::read_symlink(folder / "subsystem", error);
    std::string bus = error ? std::string() : link.filename().string();
    if (std::find(kSleeping.begin(), kSleeping.end(), bus) != kSleeping.end()) return bus;
    folder = folder.parent_path();
  }
  return {};
}

std::vector<GpioChip> find_gpio_chips(const SystemRoots& roots) {
  std::vector<GpioChip> chips;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(roots.sys + "/bus/gpio/devices", error)) {
    const std::string name = entry.path().filename().string();
    if (number_of(name) < 0) continue;
    GpioChip chip{.name = name, .path = roots.dev + "/" + name, .label = {}, .bus = {}};
    chip.bus = sleeping_bus(entry.path().string(), roots.sys);
    ask_chip(chip);
    chips.push_back(std::move(chip));
  }
  std::sort(chips.begin(), chips.end(), [](const GpioChip& a, const GpioChip& b) {
    return number_of(a.name) < number_of(b.name);
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

}  // namespace tact::hal
