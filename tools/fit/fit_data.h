// SPDX-License-Identifier: Apache-2.0
// fit_data.h - what a law is fitted to: forces, and the shape where known, over depth at some
// sites.
//
// Signs as in a law: depth > 0 presses, < 0 pulls; the force has the sign of the depth; ring k is
// the displacement into the tissue at the radius ring_radius_m[k] from the site. It comes from the
// reference (tact-lab reference) or from a bench (fit_csv.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/contact/contact_point.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "tools/ground_truth/reference_data.h"

namespace tact::tools::fit {

struct FitSample {
  double depth_m = 0.0;
  double force_N = 0.0;
  std::vector<double> ring_m{};  // one per radius, or empty; NaN: not known
};

/// Where laws that differ from place to place are asked.
struct FitPoint {
  model::contact::SurfacePoint surface_point{};
  model::Vec3 normal{};  // outward, unit
};

struct FitSite {
  std::string name;
  bool held_out = false;  // not fitted, only evaluated
  std::optional<FitPoint> at{};
  std::vector<FitSample> samples{};
};

struct FitData {
  std::string source{};  // for people
  std::vector<double> ring_radius_m{};
  std::vector<FitSite> sites{};
  std::optional<bool> large_strain{};  // of a reference; a bench does not say

  double peak_N() const;           // largest |force|
  double deepest_m() const;        // largest depth, 0 without press
  double farthest_pull_m() const;  // largest -depth, 0 without pull
  bool has_shapes() const;
  /// Every site has a place on the organ.
  bool has_places() const;
};

/// The vertex as a place, if the surface has it.
std::optional<FitPoint> surface_point_at_vertex(const model::mesh::SurfaceMesh& surface,
                                                std::size_t vertex);

/// Marks sites by name. An error names one that is not there, or says that none is left to fit.
std::optional<model::Error> hold_out(FitData& data, const std::vector<std::string>& names);

/// The scene says which sites are held out, `held_out` names more. `large_strain`: those cases
/// instead of the linear ones.
model::Result<FitData> fit_data_of(const ground_truth::ReferenceData& reference,
                                   const model::scene::Scene& scene,
                                   const std::vector<std::string>& held_out, bool large_strain);

}  // namespace tact::tools::fit
