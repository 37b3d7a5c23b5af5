// SPDX-License-Identifier: Apache-2.0
// law_settings.h - the numbers of every law that a scene describes.
//
// A scene may describe several laws: the chosen one is felt, the others are there to be compared
// (tact-lab chart) or to be chosen by tact-lab plan (law = "auto"). It keeps their parameters by
// type, so it includes no law; laws.h lists them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "model/parameters.h"
#include "model/settings_by_type.h"
#include "model/types.h"

namespace tact::model::scene {

/// The least law that meets [tolerance], by tact-lab plan.
inline constexpr std::string_view kAutoLaw = "auto";

/// A round lump of another modulus in the organ, in the frame of the box.
struct Inclusion {
  Vec3 center_m;
  double radius_m = 0.0, youngs_modulus_Pa = 0.0;
};

/// The organ as a linear elastic body; the box is in the mesh's own frame, before organ.position_m.
struct ElasticSettings {
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;
  Vec3 fixed_min_m{}, fixed_max_m{};  // triangles with all corners in this box are held
  std::vector<Inclusion> inclusions{};
};
/// Its numbers, without the box.
void visit(ParameterVisitor& v, ElasticSettings& elastic);

struct ComplianceSettings {
  std::string map_path;            // absolute; written by tact-lab condense
  double layer_thickness_m = 0.0;  // in place of a map: a wide layer on a support
  double working_depth_m = 0.0;    // press and pull
  std::size_t curves = 17;         // of the family, soft to stiff
  bool large_strain = true;        // organ and tip; false: small strain, as a linear reference
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
