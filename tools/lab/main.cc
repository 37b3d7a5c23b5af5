// SPDX-License-Identifier: Apache-2.0
// tact-lab: makes, measures and compares the force laws of tact.
#include "tools/lab/commands.h"

int main(int argc, char** argv) {
  using namespace tact::tools::lab;
  tact::tools::program::Program lab(
      "tact-lab", "tact-lab: makes, measures and compares the force laws of tact.",
      "Options, units and an example of each: tact-lab chart --help.");
  for (const auto add : {add_new_scene, add_condense, add_reference, add_fit, add_chart, add_plan,
                         add_sweep, add_stability})
    add(lab);
  return lab.run(argc, argv);
}
