// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "model/contact/contact_point.h"
#include "tools/chart/measure/measure.h"
#include "tools/chart/measure/ring_means.h"

namespace tact::tools::chart {
namespace {

using model::Result;
using model::Vec3;
using model::contact::Indentation;
using model::contact::SurfacePoint;
using model::contact::SurfaceView;

constexpr std::size_t kMaxRings = 128;
constexpr int kRestTicks = 3000;       // at most, for a body with inertia to come to rest
constexpr double kRestSpeed_m = 1e-9;  // a tick

Vec3 point_of(const SurfaceView& surface, const SurfacePoint& place) {
  Vec3 point{};
  for (std::size_t i = 0; i < 3; ++i)
    point += place.weight[i] * surface.vertex_m[surface.triangle[place.triangle][i]];
  return point;
}

/// Mean over the ring at radius k * pitch_m, k = 0, 1, ..., of a field that is linear over each
/// triangle (dent_m: one entry a vertex).
void ring_means(const SurfaceView& surface, const Indentation& in, double pitch_m,
                std::span<const double> indentation_m, std::span<double> ring_m) {
  const Vec3 centre = point_of(surface, in.surface_point);
  double middle_m = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    middle_m +=
        in.surface_point.weight[c] * indentation_m[surface.triangle[in.surface_point.triangle][c]];
  RingMeans means(static_cast<int>(ring_m.size()), pitch_m, middle_m);
  for (const model::contact::TriangleCorners& corner : surface.triangle) {
    std::array<Vec3, 3> p{};
    std::array<double, 3> rho{}, value{};
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = surface.vertex_m[corner[c]];
      rho[c] = norm(p[c] - centre);
      value[c] = indentation_m[corner[c]];
    }
    const Vec3 outward = normalized(cross(p[1] - p[0], p[2] - p[0]));
    // The other side of a thin lobe is no ring around the site.
    if (dot(outward, in.normal) >= kFacing) means.add_triangle(p, rho, value);
  }
  std::ranges::copy(means.means(), ring_m.begin());
}

}  // namespace

Subject::Subject(std::unique_ptr<model::scene::Scene> scene,
                 std::unique_ptr<model::scene::TissueLaw> law)
    : scene_(std::move(scene)),
      law_(std::move(law)),
      indentation_m_(scene_->organ_mesh.vertex_m.size()) {}

double Subject::tick(const Indentation& in) {
  const double force_N = law_->contact_law().respond(in).law.force_N;
  law_->contact_law().advance();
  return force_N;
}

void Subject::release() {
  law_->contact_law().leave(0);
  law_->contact_law().advance();
  // A body with inertia swings on after the tip has left.
  if (is_stepped()) wait_for_rest();
}

void Subject::shape(const Indentation& in, double pitch_m, std::span<double> ring_m) {
  if (is_stepped()) {
    fill_indentations(in.normal);
    ring_means(scene_->organ_mesh.view(), in, pitch_m, indentation_m_, ring_m);
    return;
  }
  std::array<double, kMaxRings> own{};
  const std::size_t rings = law_->contact_law().profile(in, own);
  const double own_pitch_m = law_->contact_law().ring_pitch_m();
  for (std::size_t k = 0; k < ring_m.size(); ++k) {
    // linear between the law's rings, zero beyond the last
    const double x = static_cast<double>(k) * pitch_m / own_pitch_m;
    const auto j = static_cast<std::size_t>(x);
    const double t = x - static_cast<double>(j);
    const auto at = [&](std::size_t i) { return i < std::min(rings, kMaxRings) ? own[i] : 0.0; };
    ring_m[k] = (1.0 - t) * at(j) + t * at(j + 1);
  }
}

void Subject::fill_indentations(const Vec3& normal) {
  std::fill(indentation_m_.begin(), indentation_m_.end(), 0.0);
  if (!law_->contact_law().shape(shape_)) return;
  for (std::uint32_t i = 0; i < shape_.node_count; ++i) {
    const auto& [x, y, z] = shape_.displacement_m[i];
    const Vec3 moved_m{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    indentation_m_[shape_.vertex[i]] = -dot(moved_m, normal);
  }
}

void Subject::wait_for_rest() {
  // Now and then: the sum goes over all vertices.
  constexpr int kLookEvery = 50;
  double before_m = 0.0;
  for (int i = 0; i < kRestTicks; ++i) {
    law_->contact_law().advance();
    if (i % kLookEvery != 0) continue;
    fill_indentations({0.0, 0.0, 1.0});
    double sum_m = 0.0;
    for (const double d_m : indentation_m_) sum_m += std::abs(d_m);
    if (i > 0 && std::abs(sum_m - before_m) < kRestSpeed_m) return;
    before_m = sum_m;
  }
}

Result<std::unique_ptr<Subject>> make_subject(const model::scene::Scene& scene,
                                              const model::scene::LawSizes& sizes) {
  auto own = std::make_unique<model::scene::Scene>(sized(scene, sizes));
  auto law = make_tissue_law(*own, sizes.law);
  if (!law) return law.error();
  return std::make_unique<Subject>(std::move(own), std::move(*law));
}

}  // namespace tact::tools::chart
