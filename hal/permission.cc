// SPDX-License-Identifier: Apache-2.0
#include "hal/permission.h"

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "hal/rights_remedy.h"
#include "model/io/input_file.h"

namespace tact::hal {

namespace fs = std::filesystem;

std::string first_line(const fs::path& file) {
  const auto text = model::io::read_file(file.string());
  return text ? text->substr(0, text->find('\n')) : std::string();
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) paths.push_back(entry.path());
  return paths;
}

std::optional<gid_t> haptics_group() {
  const group* const found = getgrnam("haptics");
  return found != nullptr ? std::optional(found->gr_gid) : std::nullopt;
}

Refusal why_refused(const std::string& node, const char* rule, std::optional<gid_t> group) {
  struct stat facts{};
  constexpr mode_t kOfGroup = S_IRGRP | S_IWGRP;
  const bool given = group && stat(node.c_str(), &facts) == 0 && facts.st_gid == *group &&
                     (facts.st_mode & kOfGroup) == kOfGroup;
  if (!given)
    return {fmt::format("{} may not be opened; its udev rule is missing: {}", node, rule),
            container_of() == nullptr
                ? group_remedy() + " installs it; then sudo adduser $USER haptics, and log in again"
                : fmt::format("start the container with --device {}", node)};
  return {fmt::format("{} may not be opened: it is of the group haptics, and its user is not in it",
                      node),
          "sudo adduser $USER haptics, and log in again"};
}

int access_error(const std::string& node) {
  return access(node.c_str(), R_OK | W_OK) == 0 ? 0 : errno;
}

std::string usb_node(const fs::path& device, const SystemRoots& roots) {
  const std::string prefix = device.filename().string() + ":";
  for (const fs::path& interface : entries(device)) {
    if (!interface.filename().string().starts_with(prefix)) continue;
    std::vector<fs::path> nodes = entries(interface / "tty");
    for (const fs::path& part : entries(interface))
      for (const fs::path& node : entries(part / "hidraw")) nodes.push_back(node);
    if (!nodes.empty()) return fmt::format("{}/{}", roots.dev, nodes.front().filename().string());
  }
  const auto number = [&](const char* file) {
    return std::strtoul(first_line(device / file).c_str(), nullptr, 10);
  };
  return fmt::format("{}/bus/usb/{:03}/{:03}", roots.dev, number("busnum"), number("devnum"));
}

const UsbPart* usb_part_of(const fs::path& device, std::span<const UsbPart> parts) {
  const std::string vendor = first_line(device / "idVendor");
  const std::string product = first_line(device / "idProduct");
  const auto known = std::ranges::find_if(parts, [&](const UsbPart& part) {
    return vendor == part.vendor && (part.product == nullptr || product == part.product);
  });
  return known == parts.end() ? nullptr : &*known;
}

std::optional<Refusal> refused_usb_device(std::span<const UsbPart> parts,
                                          const SystemRoots& roots) {
  for (const fs::path& device : entries(roots.sys + "/bus/usb/devices")) {
    const UsbPart* const part = usb_part_of(device, parts);
    if (part == nullptr) continue;
    const std::string node = usb_node(device, roots);
    if (open_when_permitted([&] { return access_error(node); }) == EACCES)
      return why_refused(node, part->rule);
  }
  return std::nullopt;
}

}  // namespace tact::hal
