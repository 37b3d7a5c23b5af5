// SPDX-License-Identifier: Apache-2.0
// doctor_table.h - the rows of pc_check.h as a table for people.
#pragma once

#include <string>
#include <vector>

#include "firmware/pc/pc_check.h"

namespace tact::tools::doctor {

/// One line a row: name, verdict, what was found; below a row that is not green why it matters and
/// the cure. Then how many are red. `colour`: for a terminal.
std::string make_doctor_table(const std::vector<firmware::pc::PcRow>& rows, bool colour);

}  // namespace tact::tools::doctor
