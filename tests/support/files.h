// SPDX-License-Identifier: Apache-2.0
// files.h - what programs wrote, read back whole.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tact::tests {

/// All bytes of a file; empty if it cannot be read.
inline std::string content(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace tact::tests
