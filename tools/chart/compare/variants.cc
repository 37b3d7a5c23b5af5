// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>

#include "tools/chart/compare/chart.h"

namespace tact::tools::chart {

using model::scene::LawKind;
using model::scene::LawSizes;

std::string Variant::family() const { return std::string(name_of(sizes.law)); }

std::string Variant::size() const {
  const std::string whole = text_of(sizes);
  const std::size_t name = family().size();
  return whole.size() > name ? whole.substr(name + 1) : "as the scene says";
}

std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantRequest& request) {
  std::vector<Variant> out;
  const auto wants = [&](LawKind kind) {
    const auto asked = std::ranges::find(request.laws, std::string(name_of(kind)));
    return scene.describes(kind) && (request.laws.empty() || asked != request.laws.end());
  };
  const auto add = [&out](const LawSizes& sizes) { out.push_back({.sizes = sizes}); };
  using Sizes = std::initializer_list<std::size_t>;
  const auto each = [&](LawKind kind, std::size_t LawSizes::* size, Sizes whole, Sizes quick) {
    if (!wants(kind)) return;
    for (const std::size_t n : request.quick ? quick : whole) {
      LawSizes sizes{.law = kind};
      sizes.*size = n;
      add(sizes);
    }
  };
  // Each about twice the one before: the chart shows where more buys nothing.
  each(LawKind::kRhombus, &LawSizes::table_knots, {17, 33, 65, 129}, {17, 65});
  // At most the scene's: more layers would be another tissue.
  const std::size_t layers = scene.disc_stack.delays.layers;
  if (wants(LawKind::kDiscStack))
    for (const auto form :
         {model::indent::DiscForm::kLinear, model::indent::DiscForm::kAlmenLaszlo}) {
      if (!request.quick && layers > 1)
        add({.law = LawKind::kDiscStack, .layers = layers / 2, .disc_form = form});
      add({.law = LawKind::kDiscStack, .layers = layers, .disc_form = form});
    }
  each(LawKind::kHexSheet, &LawSizes::rings, {3, 5, 10, 15, 25}, {5, 15});
  if (wants(LawKind::kHuntCrossley)) add({.law = LawKind::kHuntCrossley});
  each(LawKind::kSpringPatch, &LawSizes::nodes, {50, 100, 200, 500, 1000}, {100});
  // Two sizes, one after the other: curves over the organ, then knots of a curve.
  each(LawKind::kCompliance, &LawSizes::curves, {2, 3, 5, 9, 17, 33}, {5, 17});
  if (request.quick || !wants(LawKind::kCompliance)) return out;
  for (const std::size_t knots : Sizes{17, 33, 129})
    add({.law = LawKind::kCompliance, .table_knots = knots, .curves = scene.compliance.curves});
  return out;
}

std::vector<std::string> all_families() {
  std::vector<std::string> out;
  for (const model::scene::LawName& law : model::scene::kLawNames)
    if (law.kind != LawKind::kAuto) out.emplace_back(law.name);
  return out;
}

}  // namespace tact::tools::chart
