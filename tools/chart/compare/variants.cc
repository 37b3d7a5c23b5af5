// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "model/indent/disc_stack.h"
#include "model/scene/laws.h"
#include "tools/chart/compare/chart.h"

namespace tact::tools::chart {

using model::scene::LawRow;
using model::scene::LawSizes;

std::string Variant::size() const {
  const std::string whole = text_of(sizes);
  return whole.size() > sizes.law.size() ? whole.substr(sizes.law.size() + 1) : "as the scene says";
}

std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantRequest& request) {
  std::vector<Variant> out;
  const auto add = [&out](const LawSizes& sizes) { out.push_back({.sizes = sizes}); };
  for (const std::string& law : wanted_laws(scene, request)) {
    const LawRow& row = *model::scene::find_law(law);
    for (const std::size_t n : request.quick ? row.quick_sizes : row.sizes) {
      LawSizes sizes{.law = law};
      (row.size_key.empty() ? sizes.table_knots : sizes.size) = n;
      add(sizes);
    }
    if (law == "disc_stack") {
      // At most the scene's: more layers would be another tissue.
      const std::size_t layers = scene.laws.of<model::indent::DiscStackParameters>().delays.layers;
      for (const char* form : {"linear", "almen-laszlo"}) {
        if (!request.quick && layers > 1) add({.law = law, .size = layers / 2, .disc_form = form});
        add({.law = law, .size = layers, .disc_form = form});
      }
    } else if (row.sizes.empty()) {
      add({.law = law});
    }
    // Two sizes, one after the other: curves over the organ, then knots of a curve.
    if (law == "compliance" && !request.quick)
      for (const std::size_t knots : {17U, 33U, 129U})
        add({.law = law, .table_knots = knots, .size = scene.compliance.curves});
  }
  return out;
}

std::vector<std::string> wanted_laws(const model::scene::Scene& scene,
                                     const VariantRequest& request) {
  std::vector<std::string> out = all_families();
  std::erase_if(out, [&](const std::string& law) {
    return !scene.describes(law) ||
           (!request.laws.empty() && std::ranges::find(request.laws, law) == request.laws.end());
  });
  return out;
}

std::vector<std::string> all_families() {
  std::vector<std::string> out;
  for (const LawRow& row : model::scene::all_laws()) out.emplace_back(row.name);
  return out;
}

}  // namespace tact::tools::chart
