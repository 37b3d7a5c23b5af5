// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/subject/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace tact::tools::chart {
namespace {

using model::scene::LawKind;
using model::scene::LawSizes;

struct PeerName {
  PeerKind kind;
  const char* family;
};
constexpr std::array kPeers{PeerName{PeerKind::kFem, "fem"},
                            PeerName{PeerKind::kSpringMesh, "spring_mesh"},
                            PeerName{PeerKind::kBulletSurface, "bullet_surface"},
                            PeerName{PeerKind::kBulletVolume, "bullet_volume"}};

/// Sizes of one law: `whole` of them, `quick` fewer.
class List {
 public:
  List(const model::scene::Scene& scene, const VariantWish& wish) : scene_(scene), wish_(wish) {}

  void laws();
  void peers();
  std::vector<Variant> take() { return std::move(out_); }

 private:
  bool wants(const std::string& family) const {
    return wish_.laws.empty() ||
           std::find(wish_.laws.begin(), wish_.laws.end(), family) != wish_.laws.end();
  }
  bool wants(LawKind kind) const {
    return scene_.describes(kind) && wants(std::string(name_of(kind)));
  }
  void add(const LawSizes& sizes) {
    out_.push_back({.sizes = sizes, .peer = PeerKind::kNone, .peer_size = 0});
  }
  void each(std::initializer_list<std::size_t> whole, std::initializer_list<std::size_t> quick,
            LawKind kind, std::size_t LawSizes::* size) {
    for (const std::size_t n : wish_.quick ? quick : whole) {
      LawSizes sizes{.law = kind};
      sizes.*size = n;
      add(sizes);
    }
  }
  void discs();

  const model::scene::Scene& scene_;
  const VariantWish& wish_;
  std::vector<Variant> out_;
};

void List::discs() {
  // At most the scene's: more layers would be another tissue.
  const std::size_t layers = scene_.disc_stack.delays.layers;
  for (const auto form :
       {model::indent::DiscForm::kLinear, model::indent::DiscForm::kAlmenLaszlo}) {
    if (!wish_.quick && layers > 1)
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
  if (wish_.quick) return;
  for (const std::size_t knots : std::array<std::size_t, 3>{17, 33, 129})
    add({.law = LawKind::kCompliance, .table_knots = knots, .curves = scene_.compliance.curves});
}

void List::peers() {
  const auto each_size = [&](PeerKind kind, std::initializer_list<std::size_t> sizes) {
    for (const std::size_t size : sizes)
      out_.push_back({.sizes = {}, .peer = kind, .peer_size = size});
  };
  // Sizes in um: edges of 12, 8 and 5 mm. Without [elastic] it has no material.
  if (wants("fem") && scene_.elastic) each_size(PeerKind::kFem, {12000, 8000, 5000});
  if (wants("spring_mesh")) each_size(PeerKind::kSpringMesh, {5, 10, 20});
  if (wants("bullet_surface")) each_size(PeerKind::kBulletSurface, {4, 10, 20});
  if (wants("bullet_volume")) each_size(PeerKind::kBulletVolume, {4, 10, 20});
}

}  // namespace

std::string Variant::family() const {
  for (const PeerName& name : kPeers)
    if (name.kind == peer) return name.family;
  return std::string(name_of(sizes.law));
}

std::string Variant::size() const {
  if (peer == PeerKind::kFem) return fmt::format("{:g} mm", static_cast<double>(peer_size) * 1e-3);
  if (is_peer()) return fmt::format("{} iterations", peer_size);
  const std::string whole = text_of(sizes);
  const std::size_t name = family().size();
  return whole.size() > name ? whole.substr(name + 1) : "as the scene says";
}

std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantWish& wish) {
  List list(scene, wish);
  list.laws();
  if (wish.peers) list.peers();
  return list.take();
}

std::vector<std::string> all_families() {
  std::vector<std::string> out;
  for (const model::scene::LawName& law : model::scene::kLawNames)
    if (law.kind != LawKind::kAuto) out.emplace_back(law.name);
  for (const PeerName& peer : kPeers) out.emplace_back(peer.family);
  return out;
}

}  // namespace tact::tools::chart
