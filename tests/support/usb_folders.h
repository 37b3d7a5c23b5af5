// SPDX-License-Identifier: Apache-2.0
// usb_folders.h - one USB device in a sysfs and a /dev of a test's own.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "hal/permission.h"

namespace tact::tests {

class UsbFolders {
 public:
  UsbFolders(const char* vendor, const char* product) {
    std::filesystem::create_directories(device);
    for (const auto& [file, word] :
         {std::pair{"idVendor", vendor}, {"idProduct", product}, {"busnum", "1"}, {"devnum", "7"}})
      std::ofstream(device + "/" + file) << word << '\n';
    add_node(node, 0660);
  }
  ~UsbFolders() { std::filesystem::remove_all(root); }
  UsbFolders(const UsbFolders&) = delete;
  UsbFolders& operator=(const UsbFolders&) = delete;

  void add_node(const std::string& path, mode_t mode) const {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path).flush();
    chmod(path.c_str(), mode);
  }
  hal::SystemRoots roots() const { return {.sys = root + "/sys", .dev = root + "/dev"}; }

  const std::string root = testing::TempDir() + "tact-usb-" + std::to_string(getpid());
  const std::string device = root + "/sys/bus/usb/devices/1-2";
  const std::string node = root + "/dev/bus/usb/001/007";
};

/// For a process that ends soon: root may open any node.
inline void drop_privileges() {
  constexpr uid_t kOther = 65534;
  if (geteuid() == 0 && setreuid(kOther, kOther) != 0) _exit(2);
}

}  // namespace tact::tests
