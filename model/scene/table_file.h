// SPDX-License-Identifier: Apache-2.0
// table_file.h - the file of law = "table": one press as a bench writes it, CSV.
//
//     # a comment                depth_mm or depth_m   from the contact, press positive
//     depth_mm,force_N           force_N or force_mN   on the tool, outward positive
//     0.0,0.0                    others are not read
//     0.1,0.004
#pragma once

#include <string>
#include <vector>

#include "model/indent/table_law.h"
#include "model/result.h"

namespace tact::model::scene {

/// An error names the file and the line.
Result<std::vector<indent::TableRow>> read_table_file(const std::string& path);

}  // namespace tact::model::scene
