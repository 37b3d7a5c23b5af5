// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/tool_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/mesh/turn.h"
#include "model/scene/scene_strokes.h"
#include "tools/ground_truth/ring_means.h"
#include "tools/reference/organ/surface_rays.h"
#include "tools/reference/plan/reference_plan.h"

namespace tact::tools::reference {
namespace {

using ground_truth::ToolCase;
using ground_truth::ToolPoint;
using model::Result;
using model::Vec3;
using model::contact::ProbeSphere;

constexpr double kDefaultToolDepths_m[] = {1e-3, 2e-3, 5e-3, 10e-3};
constexpr double kTowardsHand = 0.5;  // cosine
constexpr double kSameHeight = 0.5;   // of the radius
constexpr double kThickness = 2.0;    // of the deepest press
constexpr double kFromHeld = 3.0;     // of the radius
constexpr int kSamples = 10;          // of a sphere's radius, to find where it first touches
constexpr double kSkin_m = 0.03;      // from the point, whose way is kept
constexpr double kMinSlide_m = 1e-3;
constexpr double kFromAbove = 5.0;  // radii along the way, in which a first touch is looked for

/// The tool's spheres where it stands at depth 0.
std::vector<RigidSphere> spheres_at(const std::vector<ProbeSphere>& spheres, const ToolPoint& place,
                                    const Vec3& rest_inward) {
  // p(0) = point - direction reach, as a press stroke has it (scene_strokes.h)
  const double reach_m = model::scene::reach_m(spheres, rest_inward);
  std::vector<RigidSphere> out;
  for (const ProbeSphere& s : spheres)
    out.push_back({.centre_m = place.point_m - reach_m * place.direction +
                               rotate(place.orientation, s.offset_m),
                   .radius_m = s.radius_m});
  return out;
}

class PlaceFinder {
 public:
  PlaceFinder(const model::mesh::SurfaceMesh& surface, const mesh::HeldBox& held,
              const std::vector<ProbeSphere>& spheres, const Vec3& rest_inward, double deepest_m)
      : surface_(surface),
        rays_(surface),
        spheres_(spheres),
        rest_inward_(rest_inward),
        deepest_m_(deepest_m) {
    for (const auto& t : surface.triangle)
      if (held.holds(surface.vertex_m[t[0]]) && held.holds(surface.vertex_m[t[1]]) &&
          held.holds(surface.vertex_m[t[2]]))
        held_.insert(held_.end(), t.begin(), t.end());
    std::sort(held_.begin(), held_.end());
    held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
  }

  /// The tool at a vertex, its tip on it.
  ToolPoint place_at(std::uint32_t vertex) const {
    const Vec3 direction = -surface_.vertex_normal[vertex];
    return {.vertex = vertex,
            .point_m = surface_.vertex_m[vertex],
            .direction = direction,
            .orientation = model::mesh::turn_between(rest_inward_, direction),
            .cases = {}};
  }

  bool is_reachable(std::uint32_t vertex) const {
    const ToolPoint place = place_at(vertex);
    if (dot(place.direction, rest_inward_) < kTowardsHand) return false;
    for (const std::uint32_t h : held_)
      if (norm(surface_.vertex_m[h] - place.point_m) < kFromHeld * largest_m() + deepest_m_)
        return false;
    double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
    for (const RigidSphere& s : spheres_at(spheres_, place, rest_inward_)) {
      const auto met = rays_.thickness(s.centre_m, place.direction);
      if (!met || met->thick_m < kThickness * deepest_m_) return false;
      low_m = std::min(low_m, met->away_m - s.radius_m);
      high_m = std::max(high_m, met->away_m - s.radius_m);
    }
    return high_m - low_m <= kSameHeight * least_m();
  }

  /// Moved along its way until it first touches.
  ToolPoint touching(ToolPoint place) const {
    double way_m = std::numeric_limits<double>::infinity();
    for (const RigidSphere& s : spheres_at(spheres_, place, rest_inward_))
      way_m = std::min(way_m, way_until_touch_m(s, place.direction));
    if (std::isfinite(way_m)) place.point_m += way_m * place.direction;
    return place;
  }

 private:
  double largest_m() const {
    return std::max_element(spheres_.begin(), spheres_.end(), thinner)->radius_m;
  }
  double least_m() const {
    return std::min_element(spheres_.begin(), spheres_.end(), thinner)->radius_m;
  }
  static bool thinner(const ProbeSphere& a, const ProbeSphere& b) {
    return a.radius_m < b.radius_m;
  }

  double way_until_touch_m(const RigidSphere& s, const Vec3& direction) const {
    const Vec3 aside = std::abs(direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(direction, aside)), v = cross(direction, u);
    double way_m = std::numeric_limits<double>::infinity();
    for (int i = -kSamples; i <= kSamples; ++i)
      for (int j = -kSamples; j <= kSamples; ++j) {
        const double x = i * s.radius_m / kSamples, y = j * s.radius_m / kSamples;
        const double left_m2 = s.radius_m * s.radius_m - x * x - y * y;
        if (left_m2 < 0.0) continue;
        const Vec3 from_m = s.centre_m + x * u + y * v - kFromAbove * s.radius_m * direction;
        if (const auto met = rays_.thickness(from_m, direction))
          way_m = std::min(way_m, met->away_m - kFromAbove * s.radius_m - std::sqrt(left_m2));
      }
    return way_m;
  }

  const model::mesh::SurfaceMesh& surface_;
  SurfaceRays rays_;
  const std::vector<ProbeSphere>& spheres_;
  Vec3 rest_inward_;
  double deepest_m_;
  std::vector<std::uint32_t> held_;  // vertices
};

std::uint32_t nearest_vertex(const model::mesh::SurfaceMesh& surface, const Vec3& point_m) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 0; v < surface.vertex_m.size(); ++v)
    if (norm(surface.vertex_m[v] - point_m) < norm(surface.vertex_m[best] - point_m)) best = v;
  return best;
}

/// Each time the candidate that is farthest from all of `taken_m`, which grows by it.
std::vector<std::uint32_t> farthest_of(const std::vector<std::uint32_t>& candidates,
                                       const std::vector<Vec3>& vertex_m,
                                       std::vector<Vec3> taken_m) {
  std::vector<std::uint32_t> out;
  while (out.size() < std::min(kUnseenPlaces, candidates.size())) {
    std::uint32_t best = 0;
    double best_m = -1.0;
    for (const std::uint32_t v : candidates) {
      double away_m = std::numeric_limits<double>::infinity();
      for (const Vec3& t : taken_m) away_m = std::min(away_m, norm(vertex_m[v] - t));
      // Larger, not equal: a tie goes to the lowest number.
      if (away_m > best_m) best = v, best_m = away_m;
    }
    // Only places that are taken already are left.
    if (best_m <= 0.0) break;
    out.push_back(best);
    taken_m.push_back(vertex_m[best]);
  }
  return out;
}

/// The places that no fit has used: tool_plan.h has the rule.
std::vector<std::uint32_t> unseen_of(const model::scene::Scene& scene,
                                     const model::mesh::SurfaceMesh& surface,
                                     const PlaceFinder& finder) {
  std::vector<Vec3> taken_m{scene.hand_site_m - scene.organ.position_m};
  for (const auto& site : scene.reference_sites)
    if (!site.held_out && site.vertex < surface.vertex_m.size())
      taken_m.push_back(surface.vertex_m[site.vertex]);
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t v = 0; v < surface.vertex_m.size(); ++v)
    if (finder.is_reachable(v)) candidates.push_back(v);
  return farthest_of(candidates, surface.vertex_m, std::move(taken_m));
}

/// How far the hand's strokes slide the open tool along the tissue from its site: the middle and
/// the end of each slide, each place once.
std::vector<Vec3> slides_of(const model::scene::Scene& scene) {
  const double reach_m = model::scene::reach_m(scene.tool.spheres, scene.hand_inward);
  const auto along_m = [&](const Vec3& tool_m) {  // of the surface, from the site
    const Vec3 off_m = tool_m - scene.hand_site_m;
    return off_m - dot(off_m, scene.hand_inward) * scene.hand_inward;
  };
  const auto presses = [&](const model::HandWaypoint& w) {
    const double depth_m = dot(w.position_m - scene.hand_site_m, scene.hand_inward) + reach_m;
    return depth_m > 0.0 && w.grip_ratio == 0.0;
  };
  std::vector<Vec3> out;
  for (std::size_t i = 1; i < scene.hand.path.size(); ++i) {
    const auto &from = scene.hand.path[i - 1], &to = scene.hand.path[i];
    const Vec3 start_m = along_m(from.position_m), end_m = along_m(to.position_m);
    if (!presses(from) || !presses(to) || norm(end_m - start_m) < kMinSlide_m) continue;
    for (const Vec3& slid_m : {0.5 * (start_m + end_m), end_m})
      if (std::none_of(out.begin(), out.end(),
                       [&](const Vec3& o) { return norm(o - slid_m) < kMinSlide_m; }))
        out.push_back(slid_m);
  }
  return out;
}

}  // namespace

void ask_for_skin(ToolPlan& plan) {
  const model::mesh::SurfaceMesh& surface = plan.organ.surface;
  for (ToolPoint& place : plan.places)
    for (std::uint32_t v = 0; v < surface.vertex_m.size(); ++v)
      if (norm(surface.vertex_m[v] - place.point_m) < kSkin_m &&
          dot(surface.vertex_normal[v], place.direction) < -ground_truth::kFacing)
        place.skin.push_back(v);
}

Result<ToolPlan> tool_plan_of(const model::scene::Scene& scene,
                              const std::vector<std::uint32_t>& vertices,
                              const std::vector<double>& depths_m, int level) {
  auto single = plan_of(scene);
  if (!single) return single.error();
  ToolPlan plan{.organ = single->organ,
                .mesh_name = single->mesh_name,
                .sphere = scene.tool.spheres,
                .places = {},
                .depths_m = depths_m,
                .level = level};
  if (plan.depths_m.empty())
    plan.depths_m.assign(std::begin(kDefaultToolDepths_m), std::end(kDefaultToolDepths_m));
  const model::mesh::SurfaceMesh& surface = plan.organ.surface;
  const Vec3 inward = scene.hand_inward, site_m = scene.hand_site_m - scene.organ.position_m;
  single->depths_m = plan.depths_m;
  single->sites = vertices.empty() ? std::vector{nearest_vertex(surface, site_m)} : vertices;
  if (auto error = check(*single)) return std::move(*error);
  const PlaceFinder finder(surface, plan.organ.held, plan.sphere, inward, plan.depths_m.back());
  plan.places.push_back(
      {.vertex = {}, .point_m = site_m, .direction = inward, .orientation = {}, .cases = {}});
  for (const Vec3& slid_m : vertices.empty() ? slides_of(scene) : std::vector<Vec3>{})
    plan.places.push_back(finder.touching({.vertex = {},
                                           .slid_m = slid_m,
                                           .point_m = site_m + slid_m,
                                           .direction = inward,
                                           .orientation = {},
                                           .cases = {}}));
  for (const std::uint32_t v : vertices.empty() ? unseen_of(scene, surface, finder) : vertices)
    plan.places.push_back(finder.touching(finder.place_at(v)));
  return plan;
}

std::vector<ToolPress> presses_of(const ToolPlan& plan) {
  std::vector<ToolPress> out;
  const auto rest_inward = plan.places.front().direction;  // of the hand's own site
  for (const int level : {plan.level, plan.level - 1}) {
    if (level < kRoughLevel) continue;
    for (const ToolPoint& place : plan.places)
      out.push_back({.direction = place.direction,
                     .sphere = spheres_at(plan.sphere, place, rest_inward),
                     .depths_m = plan.depths_m,
                     .skin = level == plan.level ? place.skin : std::vector<std::uint32_t>{},
                     .level = level});
  }
  return out;
}

ground_truth::ToolReference assemble(const ToolPlan& plan,
                                     const std::vector<std::vector<ToolCase>>& solved,
                                     const std::string& solver) {
  ground_truth::ToolReference out{.body = solved_body(plan.organ, plan.mesh_name, solver),
                                  .sphere = plan.sphere,
                                  .places = plan.places};
  const std::size_t n = plan.places.size();
  for (std::size_t i = 0; i < n; ++i) {
    out.places[i].cases = solved[i];
    for (std::size_t k = 0; k < solved[i].size(); ++k) {
      ToolCase& c = out.places[i].cases[k];
      c.force_error_ratio = remaining_error(c.force_N, solved[n + i][k].force_N);
    }
  }
  return out;
}

}  // namespace tact::tools::reference
