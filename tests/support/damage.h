// SPDX-License-Identifier: Apache-2.0
// damage.h - a file with one bit changed or its end cut off, in every part of it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace tact::tests {

/// `is_reported(path)` of copies beside the file: 200 with a bit flipped, 30 cut off, spread over
/// it.
template <typename IsReported>
void expect_all_damage_is_reported(const std::string& path, const IsReported& is_reported) {
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const std::string copy = path + ".damaged";
  const auto try_with = [&](const std::string& bytes, const std::string& what) {
    std::ofstream(copy, std::ios::binary) << bytes;
    EXPECT_TRUE(is_reported(copy)) << what << " of " << whole.size() << " bytes is not reported";
  };
  try_with(whole + "x", "a byte more");
  for (std::size_t i = 0; i < 200; ++i) {
    std::string bytes = whole;
    const std::size_t at = i * (whole.size() - 1) / 199;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (i % 8)));
    try_with(bytes, "bit " + std::to_string(i % 8) + " of byte " + std::to_string(at));
  }
  for (std::size_t i = 0; i < 30; ++i)
    try_with(whole.substr(0, i < 10 ? whole.size() - 1 - i : i * whole.size() / 30),
             "cut number " + std::to_string(i));
  std::filesystem::remove(copy);
}

}  // namespace tact::tests
