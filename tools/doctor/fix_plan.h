// SPDX-License-Identifier: Apache-2.0
// fix_plan.h - what --fix would do about the red rows: files of its own, never a line in a file of
// somebody else.
#pragma once

#include <string>
#include <vector>

#include "firmware/pc/pc_check.h"

namespace tact::tools::doctor {

/// A whole file.
struct DropIn {
  std::string path;
  std::string content;
  std::vector<std::string> packaged{};  // where a package may have it: the same bytes there will do
};

/// A program with its arguments, and the one that takes it back.
struct FixCommand {
  std::string file;  // run when this one was written; empty: always
  std::vector<std::string> words;
  std::vector<std::string> back;
  bool back_last = false;  // once the files are back
};

struct FixPlan {
  std::vector<DropIn> files;         // as they should be, whether or not they stand so already
  std::vector<FixCommand> commands;  // after the files
  std::vector<std::string> left;     // red rows that only a person can cure: "NAME: CURE"
};

// Read before that of the package tact-rt, which then adds nothing.
inline constexpr const char* kGrubDropIn = "/etc/default/grub.d/tact-doctor.cfg";
inline constexpr const char* kPackagedGrubDropIn = "/etc/default/grub.d/tact-rt.cfg";
inline constexpr const char* kLimitsDropIn = "/etc/security/limits.d/tact-doctor.conf";
inline constexpr const char* kUnit = "/etc/systemd/system/tact-pc.service";

/// Whoever shall join the group haptics; empty: nobody. `has_group`: this PC has that group.
struct FixPeople {
  std::string user;
  bool has_group = false;
};

/// `rows` are those of check_pc() to the same question. The limits are planned whatever the rows
/// say: to root, who asks, they do not apply.
FixPlan plan_fix(const firmware::pc::PcQuestion& question,
                 const std::vector<firmware::pc::PcRow>& rows, const FixPeople& people);

}  // namespace tact::tools::doctor
