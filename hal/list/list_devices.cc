// SPDX-License-Identifier: Apache-2.0
#include "hal/list/list_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "hal/can/can_open.h"
#include "hal/permission.h"

namespace tact::hal::list {
namespace {

namespace fs = std::filesystem;

// linux/if_arp.h and linux/if.h.
constexpr int kArpHrdCan = 280;
constexpr unsigned long kInterfaceUp = 0x1;

unsigned long number_of(const fs::path& file, int base) {
  return std::strtoul(first_line(file).c_str(), nullptr, base);
}

int lasting_access_error(const std::string& path) {
  return open_when_permitted([&] { return access_error(path); });
}

void lack(FoundPart& part, const Refusal& refusal) {
  part.lacking = refusal.lacking;
  part.remedy = refusal.remedy;
}

void lack_permission(FoundPart& part, const std::string& node, const char* rule, int error) {
  if (error == 0) return;
  if (error == EACCES || error == EPERM) {
    lack(part, why_refused(node, rule));
  } else {
    part.lacking = fmt::format("{} cannot be opened: {}", node, std::strerror(error));
    part.remedy = "unplug it, plug it in again, and look at dmesg";
  }
}

std::optional<can::CanLink> system_can_link(const std::string& interface) {
  const auto link = can::read_can_link(interface);
  return link ? std::optional(*link) : std::nullopt;
}

FoundPart can_part(const PartProbes& probes, const fs::path& folder) {
  const std::string name = folder.filename().string();
  can::CanLink link;
  link.is_can = true;
  link.up = (number_of(folder / "flags", 16) & kInterfaceUp) != 0;
  if (const auto known = probes.can_link == nullptr ? std::nullopt : probes.can_link(name))
    link = *known;
  FoundPart part{
      .kind = "can",
      .name = name,
      .what = fmt::format("CAN interface, {}", link.up ? "up" : "down"),
      .scene = fmt::format("device.kind = \"can-odrive\", \"can-cia402\" or \"can-moteus\", "
                           "device.can.interface = \"{}\"",
                           name),
      .lacking = {},
      .remedy = {}};
  if (link.bitrate.value_or(0) != 0) part.what += fmt::format(", {} bit/s", *link.bitrate);
  // No bits and no rate: what a scene would load the bus with is not known here.
  if (const auto refusal = check_can_link(link, name, 0, 0.0)) lack(part, *refusal);
  return part;
}

/// The driver of any interface of a USB device; empty when none has one.
std::string bound_driver(const fs::path& device) {
  const std::string prefix = device.filename().string() + ":";
  for (const fs::path& path : entries(device)) {
    if (!path.filename().string().starts_with(prefix)) continue;
    std::error_code error;
    const fs::path driver = fs::read_symlink(path / "driver", error);
    if (!error) return driver.filename().string();
  }
  return {};
}

void lack_driver(FoundPart& part, const UsbPart& known, const std::string& driver) {
  if (driver.empty()) return;
  part.what += fmt::format(", bound to {}", driver);
  // Missing rights come first: without them the driver's remedy cannot be tried.
  if (!part.lacking.empty()) return;
  if (driver == "usbfs") {
    part.lacking = "another program uses it";
    part.remedy = "end that program";
  } else if (known.path_key != nullptr) {
    // What a vendor's library does about a driver is not known here.
    part.lacking = fmt::format("the kernel driver {} holds it", driver);
    part.remedy =
        fmt::format("echo {}:1.0 | sudo tee /sys/bus/usb/drivers/{}/unbind", part.name, driver);
  }
}

FoundPart usb_part(const PartProbes& probes, const fs::path& folder, const UsbPart& known) {
  FoundPart part{.kind = known.kind,
                 .name = folder.filename().string(),
                 .what = known.name,
                 .scene = fmt::format("device.kind = \"{}\"", known.kind),
                 .lacking = {},
                 .remedy = {}};
  if (known.path_key != nullptr)
    part.scene += fmt::format(", {} = \"{}\"", known.path_key, part.name);
  else if (const std::string words = first_line(folder / "product"); !words.empty())
    part.what += fmt::format(" \"{}\"", words);
  part.what +=
      fmt::format(", USB {}:{}", first_line(folder / "idVendor"), first_line(folder / "idProduct"));
  const std::string node = usb_node(folder, probes.roots);
  lack_permission(part, node, known.rule, probes.access_error(node));
  lack_driver(part, known, bound_driver(folder));
  return part;
}

FoundPart gpio_part(const PartProbes& probes, const gpio::GpioChip& chip) {
  FoundPart part{.kind = "gpio",
                 .name = chip.name,
                 .what = "GPIO chip",
                 .scene = fmt::format("device.lines.chip = \"{}\"",
                                      chip.label.empty() ? chip.path : chip.label),
                 .lacking = {},
                 .remedy = {}};
  if (!chip.label.empty()) part.what += fmt::format(" \"{}\"", chip.label);
  if (chip.lines >= 0) part.what += fmt::format(", {} lines", chip.lines);
  part.what += chip.bus.empty() ? ", does not sleep" : fmt::format(", may sleep (on {})", chip.bus);
  if (!chip.bus.empty()) {
    part.lacking = "an access may wait for milliseconds, so it cannot carry safety lines";
    part.remedy = "use a chip on PCI, LPC or the processor itself";
  } else {
    const int error = probes.access_error(chip.path);
    lack_permission(part, chip.path, gpio::kGpioRule, error != 0 ? error : chip.error);
  }
  return part;
}

}  // namespace

PartProbes system_probes(std::vector<UsbPart> usb) {
  return {.roots = {},
          .usb = std::move(usb),
          .access_error = lasting_access_error,
          .can_link = system_can_link};
}

std::vector<FoundPart> list_devices(const PartProbes& probes) {
  std::vector<FoundPart> found;
  for (const fs::path& folder : entries(probes.roots.sys + "/class/net"))
    if (number_of(folder / "type", 10) == kArpHrdCan) found.push_back(can_part(probes, folder));
  // By name, in the order of the devices.
  std::ranges::sort(found, {}, &FoundPart::name);
  std::vector<fs::path> on_usb = entries(probes.roots.sys + "/bus/usb/devices");
  std::ranges::sort(on_usb);
  for (const UsbPart& known : probes.usb)
    for (const fs::path& folder : on_usb)
      if (usb_part_of(folder, probes.usb) == &known)
        found.push_back(usb_part(probes, folder, known));
  for (const gpio::GpioChip& chip : gpio::find_gpio_chips(probes.roots))  // by number already
    found.push_back(gpio_part(probes, chip));
  return found;
}

std::vector<std::string> absent_parts(const std::vector<FoundPart>& found,
                                      const std::vector<UsbPart>& usb) {
  std::vector<std::string> texts;
  const auto add = [&](std::string_view kind, const char* absence) {
    if (absence != nullptr && std::ranges::find(found, kind, &FoundPart::kind) == found.end())
      texts.emplace_back(absence);
  };
  add("can", "no CAN interface; plug in an adapter whose driver the kernel has (ip link shows it)");
  for (const UsbPart& part : usb) add(part.kind, part.absence);
  add("gpio", "no GPIO chip; load the driver of the board that has one (gpiodetect shows it)");
  return texts;
}

}  // namespace tact::hal::list
