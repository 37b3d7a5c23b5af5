// SPDX-License-Identifier: Apache-2.0
// pictures.h - the gnuplot scripts of tact-lab stability; each reads the CSV of its own map.
#pragma once

#include <vector>

#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {

std::vector<report::Picture> integrator_pictures(Grid grid);
std::vector<report::Picture> printed_rhombus_pictures(Grid grid);
std::vector<report::Picture> law_limit_pictures(Grid grid);
std::vector<report::Picture> law_line_pictures(Grid grid);
std::vector<report::Picture> loop_pictures(Grid grid);
std::vector<report::Picture> law_loop_pictures(Grid grid);
std::vector<report::Picture> tick_pictures(Grid grid);
std::vector<report::Picture> loss_pictures(Grid grid);

}  // namespace tact::tools::stability
