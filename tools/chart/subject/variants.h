// SPDX-License-Identifier: Apache-2.0
// variants.h - what a chart compares: every law of the scene in several sizes.
#pragma once

#include <string>
#include <vector>

#include "model/scene/plan_file.h"
#include "model/scene/scene.h"

namespace tact::tools::chart {

struct Variant {
  model::scene::LawSizes sizes{};

  std::string family() const;  // "rhombus"
  std::string size() const;    // "65 knots"
};

struct VariantRequest {
  std::vector<std::string> laws;  // families; empty: all
  bool quick = false;             // fewer sizes
};

/// In the order of the table. Laws that the scene does not describe are left out.
std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantRequest& request);
/// Every family there is, for --laws.
std::vector<std::string> all_families();

}  // namespace tact::tools::chart
