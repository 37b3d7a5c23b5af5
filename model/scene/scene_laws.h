// SPDX-License-Identifier: Apache-2.0
// scene_laws.h - the keys of a scene that say what the tissue is: its laws, their options, and the
// elastic body they stand for. Part of the format in scene_keys.h.
#pragma once

#include "model/scene/scene_keys.h"

namespace tact::model::scene {

/// `law` and the sections of all laws; the chosen one must be there.
void visit_laws(reader::Keys& root, SceneText& out);
/// [pull] and [relaxation], of any law.
void visit_law_options(reader::Keys& root, Scene& scene);
/// [elastic], [[reference_site]] and [tolerance]: what reference, fit and plan of tact-lab ask.
void visit_truth(reader::Keys& root, Scene& scene);

}  // namespace tact::model::scene
