// SPDX-License-Identifier: Apache-2.0
// drive_settings.h - what is written to a CiA 402 drive before the loop, as vendors' drives take
// it.
//
//     1800:01  bit 30, "no remote request", stays as the drive has it
//     1016:01, 1017  heartbeat, theirs and ours: a drive without is refused
//     100C, 100D  node guarding that another host has left on is switched off: its life time would
//                 end under ours, and beside it some drives do not miss a heartbeat
//     1016     a watch that a run before has left behind is switched off by its own node first,
//              and one over our node under another sub-index
//     1005     SYNC is 0x80, and not theirs to send
//     1019     it comes without a counter
//     1006     its period, where a drive has one: else it misses SYNC, or follows another clock
//     6007, 60C2, 605A, 6061  not every drive has them
//
// CN-3, CN-4, CN-6, CN-7. Set-up code: blocks.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/sdo_client.h"

namespace tact::hal::cia402 {

class DriveSettings {
 public:
  explicit DriveSettings(SdoClient& sdo) : sdo_(sdo) {}

  /// Nothing when all is written; else why not, as what follows a drive's name.
  std::optional<std::string> write(int node, CstConfiguration wanted);
  /// The settings that drives do not have, and what then counts; empty: none.
  std::string caution() const;

 private:
  struct Optional {
    std::uint16_t index;
    const char* words;
    std::vector<int> nodes{};  // that lack it
  };

  std::optional<std::string> check_heartbeat(int node);
  std::optional<std::string> end_guarding(int node);
  std::optional<std::string> end_watch(int node, const CstConfiguration& wanted);
  std::optional<std::string> end_other_watches(int node, const CstConfiguration& wanted);
  std::optional<std::string> expect_sync(int node, const CstConfiguration& wanted);
  std::optional<std::string> check_mode(int node);
  bool may_lack(int node, std::uint16_t index);

  SdoClient& sdo_;
  std::array<Optional, 3> optional_{{
      {0x6007, "what they do when tactd is gone is in their own settings; see that they let go"},
      {0x605A, "how they stop is in their own settings; see that a quick stop lets go"},
      {0x60C2, "their period is their own; see that it is that of SYNC, or shorter"},
  }};
};

}  // namespace tact::hal::cia402
