// SPDX-License-Identifier: Apache-2.0
#include "model/scene/law_numbers.h"

#include <algorithm>
#include <iterator>

#include "model/reader/scene_reader.h"
#include "model/scene/scene_keys.h"

namespace tact::model::scene {

Result<std::vector<reader::SceneNumber>> law_numbers(const Scene& scene,
                                                     const std::vector<std::string>& overrides) {
  const Result<reader::SceneDocument> document = reader::load_scene_document(scene.path, overrides);
  if (!document) return document.error();
  SceneText text;
  reader::SceneVisit visit(&*document);
  reader::Keys::visit_root(visit, [&](reader::Keys& root) { visit_scene(root, text); });
  if (auto problem = visit.problem()) return *problem;
  const std::string section = std::string(name_of(scene.law)) + ".";
  std::vector<reader::SceneNumber> out;
  std::ranges::copy_if(
      visit.numbers(), std::back_inserter(out),
      [&section](const reader::SceneNumber& number) { return number.key.starts_with(section); });
  return out;
}

}  // namespace tact::model::scene
