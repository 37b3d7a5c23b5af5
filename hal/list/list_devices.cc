// SPDX-License-Identifier: Apache-2.0
#include "hal/list/list_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <tuple>

#include "hal/can/can_open.h"
#include "hal/permission.h"
#include "hal/udev_rules.h"
#include "model/io/input_file.h"

namespace tact::hal::list {
namespace {

namespace fs = std::filesystem;

// linux/if_arp.h and linux/if.h.
constexpr int kArpHrdCan = 280;
constexpr unsigned long kInterfaceUp = 0x1;

/// The first line of a file; empty when it cannot be read.
std::string line_of(const fs::path& file) {
  const auto text = model::io::read_file(file.string());
  return text ? text->substr(0, text->find('\n')) : std::string();
}

unsigned long number_of(const fs::path& file, int base) {
  return std::strtoul(line_of(file).c_str(), nullptr, base);
}

std::vector<fs::path> entries(const std::string& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  return paths;
}

int lasting_access_error(const std::string& path) {
  return open_when_permitted([&] { return access_error(path); });
}

void lack_permission(FoundPart& part, const std::string& node, const char* rule, int error) {
  if (error == 0) return;
  if (error == EACCES || error == EPERM) {
    const Refusal refusal = why_refused(node, rule);
    part.lacking = refusal.lacking;
    part.remedy = refusal.remedy;
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
      .kind = PartKind::kCan,
      .name = name,
      .what = fmt::format("CAN interface, {}", link.up ? "up" : "down"),
      .scene = fmt::format("device.kind = \"can-odrive\", \"can-cia402\" or \"can-moteus\", "
                           "device.can.interface = \"{}\"",
                           name),
      .lacking = {},
      .remedy = {}};
  if (link.bitrate.value_or(0) != 0) part.what += fmt::format(", {} bit/s", *link.bitrate);
  // No bits and no rate: what a scene would load the bus with is not known here.
  if (const auto refusal = check_can_link(link, name, 0, 0.0)) {
    const std::string& message = refusal->message;  // "what: remedy"
    const std::size_t colon = std::min(message.find(": "), message.size());
    part.lacking = message.substr(0, colon);
    part.remedy = message.substr(std::min(colon + 2, message.size()));
  }
  return part;
}

/// The driver of any interface of a USB device; empty when none has one.
std::string bound_driver(const fs::path& device) {
  const std::string prefix = device.filename().string() + ":";
  for (const fs::path& path : entries(device.string())) {
    if (!path.filename().string().starts_with(prefix)) continue;
    std::error_code error;
    const fs::path driver = fs::read_symlink(path / "driver", error);
    if (!error) return driver.filename().string();
  }
  return {};
}

void lack_driver(FoundPart& part, const std::string& driver) {
  if (driver.empty()) return;
  part.what += fmt::format(", bound to {}", driver);
  // Missing rights come first: without them the driver's remedy cannot be tried.
  if (!part.lacking.empty()) return;
  if (driver == "usbfs") {
    part.lacking = "another program uses it";
    part.remedy = "end that program";
  } else if (part.kind == PartKind::kFalcon) {
    // The Falcon alone: what the vendor's library does about a driver is not known here.
    part.lacking = fmt::format("the kernel driver {} holds it", driver);
    part.remedy =
        fmt::format("echo {}:1.0 | sudo tee /sys/bus/usb/drivers/{}/unbind", part.name, driver);
  }
}

/// A device on USB that tact knows.
struct UsbKind {
  PartKind kind;
  const char* vendor;
  const char* product;  // null: any
  const char* words;
  const char* rule;
};
constexpr UsbKind kUsbKinds[] = {
    {PartKind::kFalcon, "0403", "cb48", "Novint Falcon", kFalconRule},
    {PartKind::kForceDimension, "1451", nullptr, "Force Dimension device", kForceDimensionRule},
    {PartKind::kPhantom, "2988", nullptr, "PHANTOM", kPhantomRule},
    {PartKind::kPhantom, "0301", "2988", "PHANTOM", kOldPhantomRule}};

std::optional<FoundPart> usb_part(const PartProbes& probes, const fs::path& folder) {
  const std::string vendor = line_of(folder / "idVendor"), product = line_of(folder / "idProduct");
  const auto* known = std::ranges::find_if(kUsbKinds, [&](const UsbKind& kind) {
    return vendor == kind.vendor && (kind.product == nullptr || product == kind.product);
  });
  if (known == std::end(kUsbKinds)) return std::nullopt;
  FoundPart part{.kind = known->kind,
                 .name = folder.filename().string(),
                 .what = known->words,
                 .scene = fmt::format("device.kind = \"{}\"", name_of(known->kind)),
                 .lacking = {},
                 .remedy = {}};
  if (part.kind == PartKind::kFalcon)
    part.scene += fmt::format(", device.falcon.bus_path = \"{}\"", part.name);
  else if (const std::string words = line_of(folder / "product"); !words.empty())
    part.what += fmt::format(" \"{}\"", words);
  part.what += fmt::format(", USB {}:{}", vendor, product);
  const std::string node = usb_node(folder, probes.roots);
  lack_permission(part, node, known->rule, probes.access_error(node));
  lack_driver(part, bound_driver(folder));
  return part;
}

FoundPart gpio_part(const PartProbes& probes, const gpio::GpioChip& chip) {
  FoundPart part{.kind = PartKind::kGpio,
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
    lack_permission(part, chip.path, kGpioRule, error != 0 ? error : chip.error);
  }
  return part;
}

}  // namespace

const char* name_of(PartKind kind) {
  switch (kind) {
    case PartKind::kCan:
      return "can";
    case PartKind::kFalcon:
      return "falcon";
    case PartKind::kForceDimension:
      return "force-dimension";
    case PartKind::kPhantom:
      return "phantom";
    case PartKind::kGpio:
      break;
  }
  return "gpio";
}

PartProbes system_probes() {
  return {.roots = {}, .access_error = lasting_access_error, .can_link = system_can_link};
}

std::vector<FoundPart> list_devices(const PartProbes& probes) {
  std::vector<FoundPart> found;
  for (const fs::path& folder : entries(probes.roots.sys + "/class/net"))
    if (number_of(folder / "type", 10) == kArpHrdCan) found.push_back(can_part(probes, folder));
  for (const fs::path& folder : entries(probes.roots.sys + "/bus/usb/devices"))
    if (auto part = usb_part(probes, folder)) found.push_back(std::move(*part));
  std::sort(found.begin(), found.end(), [](const FoundPart& a, const FoundPart& b) {
    return std::tie(a.kind, a.name) < std::tie(b.kind, b.name);
  });
  for (const gpio::GpioChip& chip : gpio::find_gpio_chips(probes.roots))  // by number already
    found.push_back(gpio_part(probes, chip));
  return found;
}

const char* absence_text(PartKind kind) {
  switch (kind) {
    case PartKind::kCan:
      return "no CAN interface; plug in an adapter whose driver the kernel has (ip link shows it)";
    case PartKind::kFalcon:
      return "no Novint Falcon (USB 0403:cb48); switch its supply on and plug in its cable (lsusb "
             "shows it)";
    case PartKind::kForceDimension:
      return "no Force Dimension device (USB 1451:*); switch its supply on and plug in its cable "
             "(lsusb shows it)";
    case PartKind::kPhantom:
      return "no PHANTOM or Touch on USB (2988:*); switch its supply on and plug in its cable "
             "(lsusb shows it); one on Ethernet or FireWire is not looked for";
    case PartKind::kGpio:
      break;
  }
  return "no GPIO chip; load the driver of the board that has one (gpiodetect shows it)";
}

}  // namespace tact::hal::list
