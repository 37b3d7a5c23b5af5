// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/self_check/self_check.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace tact::rig {
namespace {

constexpr int kShown = 5;  // differences of one kind

}  // namespace

int run_self_check(const std::string& folder, const std::function<void(SelfCheck&)>& checks) {
  SelfCheck check(folder);
  try {
    checks(check);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "self-check: %s\n", error.what());
    return 2;
  }
  return check.end();
}

nlohmann::json SelfCheck::load(const std::string& file) {
  std::ifstream stream(folder_ + "/" + file);
  auto content = nlohmann::json::parse(stream, nullptr, false);
  if (content.is_discarded())
    throw std::runtime_error(folder_ + "/" + file + ": unreadable; name the folder of the vectors");
  return content;
}

void SelfCheck::begin(const std::string& what) {
  if (!what_.empty()) {
    std::printf("%-32s %5d compared, %d different\n", what_.c_str(), compared_, different_);
    if (compared_ == 0) ++total_different_;
  }
  what_ = what;
  compared_ = different_ = 0;
}

void SelfCheck::count(bool good, const std::string& message) {
  ++compared_;
  if (good) return;
  ++total_different_;
  if (++different_ <= kShown) std::fprintf(stderr, "%s: %s\n", what_.c_str(), message.c_str());
}

void SelfCheck::equal(const std::string& where, double own, double theirs, double tolerance) {
  count(std::abs(own - theirs) <= tolerance,
        where + ": " + std::to_string(own) + " is not " + std::to_string(theirs));
}

void SelfCheck::same(const std::string& where, const std::string& own, const std::string& theirs) {
  count(own == theirs, where + ": " + own + " is not " + theirs);
}

int SelfCheck::end() {
  begin({});
  return total_different_ == 0 ? 0 : 1;
}

std::vector<std::uint8_t> bytes_of_hex(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

std::string hex_of(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    hex += kDigits[byte >> 4u];
    hex += kDigits[byte & 15u];
  }
  return hex;
}

}  // namespace tact::rig
