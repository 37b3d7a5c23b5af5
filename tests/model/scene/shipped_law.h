// SPDX-License-Identifier: Apache-2.0
// shipped_law.h - a shipped scene with some keys changed, and its law or why there is none.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "model/scene/tissue_law.h"

namespace tact::model::scene::shipped_law {

using Overrides = std::vector<std::string>;

/// The organ stays where it was drawn.
inline const std::string kLinear = "compliance.large_strain=false";

inline Scene shipped(const std::string& name, const Overrides& overrides = {}) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", overrides);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

inline std::unique_ptr<TissueLaw> made(const Scene& scene, const std::string& kind) {
  auto law = make_tissue_law(scene, kind);
  EXPECT_TRUE(law) << law.error().message;
  return law ? std::move(*law) : nullptr;
}

inline std::unique_ptr<TissueLaw> made(const Scene& scene) { return made(scene, scene.law); }

inline std::string refusal(const Scene& scene, const std::string& kind) {
  const auto law = make_tissue_law(scene, kind);
  return law ? "" : law.error().message;
}

}  // namespace tact::model::scene::shipped_law
