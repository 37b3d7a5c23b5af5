// SPDX-License-Identifier: Apache-2.0
// laws.h - the force laws that the maps probe, with the numbers of RC-13, DS-13 and HX-26.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/law/law.h"
#include "tools/stability/laws/memory_laws.h"

namespace tact::tools::stability {

struct NamedLaw {
  std::string name;
  std::shared_ptr<const model::law::Law> law;       // none if the law has memory
  std::shared_ptr<const model::law::Law> rendered;  // as the loop reads it: a table, if it has one
  std::string beyond;             // what a press beyond its range does, in words without commas
  double range_m = 0.0;           // of the press
  double rendered_range_m = 0.0;  // of the table
  ContactLawMaker make_contact_point{};  // of a law with memory

  bool remembers() const { return static_cast<bool>(make_contact_point); }
  /// Untouched until now.
  RenderedTissue fresh() const { return {rendered, make_contact_point}; }
};

/// Made once; a law that this build cannot make is left out.
const std::vector<NamedLaw>& probed_laws();

/// Largest dF/dd that its law gives between rest and its range, N/m.
double steepest_N_per_m(const NamedLaw& named);

}  // namespace tact::tools::stability
