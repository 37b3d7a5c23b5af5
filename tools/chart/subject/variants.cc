// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/subject/variants.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace tact::tools::chart {
namespace {

using model::scene::LawKind;
using model::scene::LawSizes;

/// Sizes of one law: `whole` of them, `quick` fewer.
class List {
 public:
  List(const model::scene::Scene& scene, const VariantRequest& request)
      : scene_(scene), request_(request) {}

  void laws();
  std::vector<Variant> take() { return std::move(out_); }

 private:
  bool wants(const std::string& family) const {
    return request_.laws.empty() ||
           std::find(request_.laws.begin(), request_.laws.end(), family) != request_.laws.end();
  }
  bool wants(LawKind kind) const {
    return scene_.describes(kind) && wants(std::string(name_of(kind)));
  }
  void add(const LawSizes& sizes) { out_.push_back({.sizes = sizes}); }
  void each(std::initializer_list<std::size_t> whole, std::initializer_list<std::size_t> quick,
            LawKind kind, std::size_t LawSizes::* size) {
    for (const std::size_t n : request_.quick ? quick : whole) {
      LawSizes sizes{.law = kind};
      sizes.*size = n;
      add(sizes);
    }
  }
  void discs();

  const model::scene::Scene& scene_;
  const VariantRequest& request_;
  std::vector<Variant> out_;
};

void List::discs() {
  // At most the scene's: more layers would be another tissue.
  const std::size_t layers = scene_.disc_stack.delays.layers;
  for (const auto form :
       {model::indent::DiscForm::kLinear, model::indent::DiscForm::kAlmenLaszlo}) {
    if (!request_.quick && layers > 1)
      add({.law = LawKind::kDiscStack, .layers = layers / 2, .disc_form = form});
    add({.law = LawKind::kDiscStack, .layers = layers, .disc_form = form});
  }
}

void List::laws() {
  if (wants(LawKind::kRhombus))
    // Each about twice the one before: the chart shows where more buys nothing.
    each({17, 33, 65, 129}, {17, 65}, LawKind::kRhombus, &LawSizes::table_knots);
  if (wants(LawKind::kDiscStack)) discs();
  if (wants(LawKind::kHexSheet))
    each({3, 5, 10, 15, 25}, {5, 15}, LawKind::kHexSheet, &LawSizes::rings);
  if (wants(LawKind::kHuntCrossley)) add({.law = LawKind::kHuntCrossley});
  if (wants(LawKind::kSpringPatch))
    each({50, 100, 200, 500, 1000}, {100}, LawKind::kSpringPatch, &LawSizes::nodes);
  // Two sizes, one after the other: curves over the organ, then knots of a curve.
  if (!wants(LawKind::kCompliance)) return;
  each({2, 3, 5, 9, 17, 33}, {5, 17}, LawKind::kCompliance, &LawSizes::curves);
  if (request_.quick) return;
  for (const std::size_t knots : std::array<std::size_t, 3>{17, 33, 129})
    add({.law = LawKind::kCompliance, .table_knots = knots, .curves = scene_.compliance.curves});
}

}  // namespace

std::string Variant::family() const { return std::string(name_of(sizes.law)); }

std::string Variant::size() const {
  const std::string whole = text_of(sizes);
  const std::size_t name = family().size();
  return whole.size() > name ? whole.substr(name + 1) : "as the scene says";
}

std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantRequest& request) {
  List list(scene, request);
  list.laws();
  return list.take();
}

std::vector<std::string> all_families() {
  std::vector<std::string> out;
  for (const model::scene::LawName& law : model::scene::kLawNames)
    if (law.kind != LawKind::kAuto) out.emplace_back(law.name);
  return out;
}

}  // namespace tact::tools::chart
