// SPDX-License-Identifier: Apache-2.0
// pc_check.h - is this PC fit for hard real time? One row per check: what was found, why it
// matters, and the remedy as a command.
//
// Only reads files (pc_files.h); nothing is changed, no device is opened. `tact-doctor` shows all
// rows, `tactd` names the red ones at its start. Evidence: RT-1 to RT-13.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "firmware/pc/pc_files.h"
#include "firmware/pc/rt_needs.h"
#include "hal/device_facts.h"

namespace tact::firmware::pc {

enum class Verdict { kGreen, kRed, kUnknown };
/// "green", "red", "unknown".
const char* name_of(Verdict verdict);
/// Green or red, and unknown where the files do not say.
constexpr Verdict verdict_of(bool known, bool good) {
  return !known ? Verdict::kUnknown : good ? Verdict::kGreen : Verdict::kRed;
}

struct PcRow {
  std::string name;
  Verdict verdict = Verdict::kUnknown;
  std::string found;   // what the files say
  std::string why;     // what it does to the loop
  std::string remedy;  // empty for a green row
};

struct PcQuestion {
  PcFiles files{};
  std::vector<hal::UsbPart> usb{};  // devices to look for: hal/registry, usb_parts()
  int core = -1;  // of the loop; -1: an isolated one if there is one, else the last
};

/// All rows, the most important first.
std::vector<PcRow> check_pc(const PcQuestion& question);
/// The core that the rows describe.
int core_in_question(const PcQuestion& question);

/// The red rows in one line, for a program that starts; empty when none is red.
std::string name_red_rows(const std::vector<PcRow>& rows);
/// [{"name","verdict","found","why","remedy"}]
nlohmann::json to_json(const std::vector<PcRow>& rows);

// The groups of check_pc(), each in a file of its own.
void check_kernel(const PcQuestion& question, std::vector<PcRow>& rows);
void check_permissions(const PcQuestion& question, std::vector<PcRow>& rows);
void check_core(const PcQuestion& question, std::vector<PcRow>& rows);
void check_others(const PcQuestion& question, std::vector<PcRow>& rows);

}  // namespace tact::firmware::pc
