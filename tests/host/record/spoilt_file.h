// SPDX-License-Identifier: Apache-2.0
// spoilt_file.h - one byte of a file is not what it was.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace tact::tests {

inline void flip_byte(const std::string& path, std::uint64_t at) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(static_cast<std::streamoff>(at));
  const int old = file.get();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(old ^ 0x40));
}

}  // namespace tact::tests
