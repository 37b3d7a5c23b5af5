// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {

std::vector<Map> all_maps() {
  return {integrator_map(), printed_rhombus_map(), law_limit_map(), law_line_map(), loop_map(),
          law_loop_map(),   delta_loop_map(),      tick_map(),      loss_map()};
}

}  // namespace tact::tools::stability
