// SPDX-License-Identifier: Apache-2.0
// law_settings.h - which law a scene chooses, and the numbers of every law that it describes.
//
// A scene may describe several laws: the chosen one is felt, the others are there to be compared
// (tact-lab chart) or to be chosen by tact-lab plan (law = "auto").
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/indent/disc_stack.h"
#include "model/indent/hex_sheet.h"
#include "model/indent/hunt_crossley.h"
#include "model/indent/rhombus_chain.h"
#include "model/law/linear_pull.h"
#include "model/law/relaxation.h"
#include "model/springs/spring_patch.h"
#include "model/types.h"

namespace tact::model::scene {

enum class LawKind {
  kRhombus,
  kDiscStack,
  kHexSheet,
  kHuntCrossley,
  kSpringPatch,
  kCompliance,
  kAuto,
};

struct LawName {
  LawKind kind;
  std::string_view name, meaning;
};

inline constexpr std::array kLawNames{
    LawName{LawKind::kRhombus, "rhombus", "energy-consistent spring chain"},
    LawName{LawKind::kDiscStack, "disc_stack", "discs that go flat one after the other"},
    LawName{LawKind::kHexSheet, "hex_sheet", "hexagonal skin on body springs, energy form"},
    LawName{LawKind::kHuntCrossley, "hunt_crossley", "power law that resists speed as well"},
    LawName{LawKind::kSpringPatch, "spring_patch", "masses and springs near the contact"},
    LawName{LawKind::kCompliance, "compliance", "linear elastic organ, condensed offline"},
    LawName{LawKind::kAuto, "auto", "the least law that meets [tolerance], by tact-lab plan"},
};

/// Its name in a scene.
constexpr std::string_view name_of(LawKind kind) {
  for (const LawName& law : kLawNames)
    if (law.kind == kind) return law.name;
  return "";
}

/// The organ as a linear elastic body; the box is in the mesh's own frame, before organ.position_m.
struct ElasticSettings {
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;
  Vec3 fixed_min_m{}, fixed_max_m{};  // triangles with all corners in this box are held
};

struct ComplianceSettings {
  std::string map_path;          // absolute; written by tact-lab condense
  double working_depth_m = 0.0;  // press and pull
  std::size_t curves = 17;       // of the family, soft to stiff
  bool large_strain = true;      // organ and tip; false: small strain, as a linear reference
};

/// What the scene accepts, for tact-lab plan and for tactd's start.
struct ToleranceSettings {
  double force_error_ratio = 0.0;  // RMS, of the peak
  double shape_error_ratio = 0.0;  // RMS, of the depth
  double tick_budget_us = 0.0;     // p99.9 of a tick
};

/// A vertex of the organ where the reference is solved.
struct ReferenceSite {
  std::size_t vertex = 0;
  bool held_out = false;  // not used by tact-lab fit
};

}  // namespace tact::model::scene
