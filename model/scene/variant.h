// SPDX-License-Identifier: Apache-2.0
// variant.h - a scene with other numbers of its law, for a run that goes on. Set-up code only.
//
// Only numbers that change the tissue and nothing else may change: those of the law in use, and E
// of [elastic] where it is felt. Device, limits and hand stay, and so do counts, as they decide how
// long a tick takes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/scene/tissue.h"

namespace tact::model::scene {

/// A number with its whole key, "rhombus.area_m2"; it points into the scene.
struct LawNumber {
  std::string key;
  Parameter number;

  bool is_live() const { return number.number != nullptr; }
};
/// Those of the law in use and of [elastic] where it is felt; a scene with law = "auto" has none.
std::vector<LawNumber> law_numbers(Scene& scene);

/// A tissue with the scene that it refers to.
struct Variant {
  std::unique_ptr<const Scene> scene;
  std::unique_ptr<Tissue> tissue;
};

/// `set` changed by `more`, each KEY=VALUE: a key of both keeps the value of `more`.
std::vector<std::string> merged(std::vector<std::string> set, std::span<const std::string> more);
/// The scene with these numbers, each KEY=VALUE. The error names a key that may not change, or the
/// range of its value.
Result<Scene> with_numbers(Scene scene, std::span<const std::string> set);
Result<Variant> make_variant(const Scene& scene, std::span<const std::string> set);

}  // namespace tact::model::scene
