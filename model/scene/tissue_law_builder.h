// SPDX-License-Identifier: Apache-2.0
// tissue_law_builder.h - how a scene's law becomes a TissueLaw; of tissue_law*.cc alone.
//
// Curves first (add_*, tissue_law.cc), then finish_*(), which lays them over the surface and
// measures what was built (tissue_law_places.cc).
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "model/scene/laws.h"
#include "model/scene/tissue_law.h"
#include "model/tissue/elastic_field.h"

namespace tact::model::scene {

class TissueLawBuilder {
 public:
  explicit TissueLawBuilder(const Scene& scene) : scene_(scene) {}

  using Step = std::optional<Error>;

  Step add_curve(const LawRow& row);
  Step add_compliance();
  Step add_spring_patch();
  std::unique_ptr<TissueLaw> take() { return std::move(law_); }

 private:
  Step add_small_compliance();
  Result<const law::Law*> on_organ(const law::Law& organ);
  Result<const law::Law*> with_pull(const law::Law& press);
  Step finish_curve(const law::Law& curve);
  Step vary_by_place(const law::Law& curve);
  Step enlarge_strain(const law::Law& curve);
  Step bend(const law::Law& curve, double organ_range_m);
  Step finish_field(const law::Law* shape = nullptr);
  tissue::ElasticNeighbours neighbours();
  void measure(const law::Law& curve);

  /// Keeps a law and returns where it lives.
  template <typename L>
  L& keep(L&& law) {
    auto owned = std::make_unique<std::decay_t<L>>(std::forward<L>(law));
    auto& place = *owned;
    law_->owned_.push_back(std::move(owned));
    return place;
  }
  Error blame(const Error& error) const { return {scene_.path + ": " + error.message}; }

  const Scene& scene_;
  bool draws_tissue_ = false;  // the law itself, not as springs in a row
  bool is_measured_ = false;   // the law's strain is large where the tissue's is
  std::unique_ptr<TissueLaw> law_ = std::make_unique<TissueLaw>();
};

}  // namespace tact::model::scene
