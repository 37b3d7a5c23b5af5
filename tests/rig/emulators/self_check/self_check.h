// SPDX-License-Identifier: Apache-2.0
// self_check.h - the published vectors, replayed through the emulators' own codec and kinematics.
//
// Numbers are compared within the tolerance the vectors give, bytes exactly. One line per kind of
// vector on stdout, one per difference on stderr. Set-up code: it allocates and reads files.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace tact::rig {

/// 0: all equal; 1: a difference; 2: a file is missing or has other fields.
int check_drives(const std::string& folder);
int check_falcon(const std::string& folder);

class SelfCheck {
 public:
  explicit SelfCheck(std::string folder) : folder_(std::move(folder)) {}

  /// The file's content; throws when it cannot be read.
  nlohmann::json load(const std::string& file);
  /// What the next comparisons are about.
  void begin(const std::string& what);
  void equal(const std::string& where, double own, double theirs, double tolerance);
  void same(const std::string& where, const std::string& own, const std::string& theirs);
  /// The lines, and the exit status; a kind of vector without any comparison is a failure.
  int end();

 private:
  void count(bool good, const std::string& message);

  std::string folder_, what_;
  int compared_ = 0, different_ = 0, total_different_ = 0;
};

/// All of `checks`, and the exit status.
int run_self_check(const std::string& folder, const std::function<void(SelfCheck&)>& checks);

std::vector<std::uint8_t> bytes_of_hex(const std::string& hex);
std::string hex_of(std::span<const std::uint8_t> bytes);

void check_delta_kinematics(SelfCheck& check);
void check_falcon_kinematics(SelfCheck& check);
void check_odrive(SelfCheck& check);
void check_cia402(SelfCheck& check);
void check_moteus(SelfCheck& check);
void check_falcon_packets(SelfCheck& check);

}  // namespace tact::rig
