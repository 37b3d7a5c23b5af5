#include "tools/stability/map.h"

namespace tact::tools {

std::vector<Map> all_maps() { return {loop_map(), law_loop_map(), tick_map(), loss_map()}; }

}  // namespace tact::tools
