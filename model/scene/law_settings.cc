// SPDX-License-Identifier: Apache-2.0
#include "model/scene/law_settings.h"

namespace tact::model::scene {

std::string_view name_of(LawKind kind) {
  for (const LawName& law : kLawNames)
    if (law.kind == kind) return law.name;
  return "";
}

}  // namespace tact::model::scene
