// pictures.h - the gnuplot scripts of tact-stability; each reads the CSV of its own map.
#pragma once

#include <vector>

#include "tools/stability/map.h"

namespace tact::tools {

std::vector<Picture> integrator_pictures(Grid grid);
std::vector<Picture> printed_rhombus_pictures(Grid grid);
std::vector<Picture> law_limit_pictures(Grid grid);
std::vector<Picture> law_line_pictures(Grid grid);
std::vector<Picture> loop_pictures(Grid grid);
std::vector<Picture> law_loop_pictures(Grid grid);
std::vector<Picture> tick_pictures(Grid grid);
std::vector<Picture> loss_pictures(Grid grid);

}  // namespace tact::tools
