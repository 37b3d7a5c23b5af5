// laws.h - the force laws that the maps probe, with the numbers that PHYSICS calls their defaults.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/law.h"

namespace tact::tools {

struct NamedLaw {
  std::string name;
  std::shared_ptr<const model::Law> law;
  std::shared_ptr<const model::Law> felt;  // as the loop reads it: a table, if it has one
  std::string beyond;  // what a press beyond its range does, in words without commas
};

/// Made once; a law that this build cannot make is left out.
const std::vector<NamedLaw>& probed_laws();

/// Largest dF/dd between rest and `depth_m`, N/m.
double steepest_N_per_m(const model::Law& law, double depth_m);

}  // namespace tact::tools
