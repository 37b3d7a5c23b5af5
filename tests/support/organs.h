// SPDX-License-Identifier: Apache-2.0
// organs.h - closed surfaces with thin, hollow, near and sharp parts, and one sphere's elastic law.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "model/contact/contact.h"
#include "model/indent/compliance_law.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::tests {

/// Two meshes as one; nothing joins them.
inline model::mesh::SurfaceMesh join(const model::mesh::SurfaceMesh& a,
                                     const model::mesh::SurfaceMesh& b) {
  std::vector<model::Vec3> vertices = a.vertex_m;
  vertices.insert(vertices.end(), b.vertex_m.begin(), b.vertex_m.end());
  std::vector<model::contact::TriangleCorners> triangles = a.triangle;
  const auto first = static_cast<std::uint32_t>(a.vertex_m.size());
  for (const auto& [i, j, k] : b.triangle) triangles.push_back({first + i, first + j, first + k});
  return *model::mesh::make_surface_mesh(std::move(vertices), std::move(triangles));
}

inline model::mesh::SurfaceMesh shifted(model::mesh::SurfaceMesh mesh, const model::Vec3& by_m) {
  model::mesh::shift(mesh, by_m);
  return mesh;
}

struct FlapShape {
  double length_m = 0.0, width_m = 0.0, thickness_m = 0.0, edge_m = 0.0;
  double bend_radius_m = 0.0;  // of the top's middle, about the y axis; 0: flat
  double gap_m = 0.0;          // above 0: folded about its middle, its halves this far apart
};

/// Closed sheet, its top at z = 0 in the middle, its rims cut square: sharp edges of 90 degrees.
inline model::mesh::SurfaceMesh make_flap(const FlapShape& shape) {
  const double fold_radius_m = 0.5 * shape.gap_m;
  const double half_turn_m = 0.5 * std::numbers::pi * fold_radius_m;
  // Along x, and off_m above the top.
  const auto section = [&](double x, double y, double off_m) -> model::Vec3 {
    if (shape.gap_m > 0.0) {
      // The fold's inner side is the top: two straight halves that face each other, and the bend.
      const double beyond = std::max(0.0, std::abs(x) - half_turn_m);
      const double angle = (x < 0 ? -1.0 : 1.0) * (std::abs(x) - beyond) / fold_radius_m;
      const double radius = fold_radius_m - off_m;
      return {radius * std::sin(angle), y, beyond - radius * std::cos(angle)};
    }
    if (shape.bend_radius_m > 0.0) {
      const double angle = x / shape.bend_radius_m, radius = shape.bend_radius_m + off_m;
      return {radius * std::sin(angle), y, radius * std::cos(angle) - shape.bend_radius_m};
    }
    return {x, y, off_m};
  };
  const auto nx = static_cast<std::uint32_t>(std::lround(shape.length_m / shape.edge_m));
  const auto ny = static_cast<std::uint32_t>(std::lround(shape.width_m / shape.edge_m));
  std::vector<model::Vec3> v;
  for (int k = 0; k < 2; ++k)
    for (std::uint32_t j = 0; j <= ny; ++j)
      for (std::uint32_t i = 0; i <= nx; ++i)
        v.push_back(section(shape.length_m * (i / double(nx) - 0.5),
                            shape.width_m * (j / double(ny) - 0.5), -k * shape.thickness_m));
  const auto at = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (k * (ny + 1) + j) * (nx + 1) + i;
  };
  std::vector<model::contact::TriangleCorners> t;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    t.push_back({a, b, c});
    t.push_back({a, c, d});
  };
  for (std::uint32_t j = 0; j < ny; ++j)
    for (std::uint32_t i = 0; i < nx; ++i) {
      add(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
      add(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1));
    }
  for (std::uint32_t i = 0; i < nx; ++i) {
    add(at(i, 0, 0), at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 0, 0));
    add(at(i + 1, ny, 0), at(i + 1, ny, 1), at(i, ny, 1), at(i, ny, 0));
  }
  for (std::uint32_t j = 0; j < ny; ++j) {
    add(at(0, j + 1, 0), at(0, j + 1, 1), at(0, j, 1), at(0, j, 0));
    add(at(nx, j, 0), at(nx, j, 1), at(nx, j + 1, 1), at(nx, j + 1, 0));
  }
  return *model::mesh::make_surface_mesh(std::move(v), std::move(t));
}

/// About the z axis.
inline model::mesh::SurfaceMesh make_torus(double ring_m, double tube_m, std::uint32_t around,
                                           std::uint32_t across) {
  std::vector<model::Vec3> v;
  std::vector<model::contact::TriangleCorners> t;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double out_m = ring_m + tube_m * std::cos(b);
      v.push_back({out_m * std::cos(a), out_m * std::sin(a), tube_m * std::sin(b)});
      const std::uint32_t p = i * across + j, q = (i + 1) % around * across + j,
                          up = (j + 1) % across, r = (i + 1) % around * across + up,
                          s = i * across + up;
      t.push_back({p, q, r});
      t.push_back({p, r, s});
    }
  return *model::mesh::make_surface_mesh(std::move(v), std::move(t));
}

/// A ball with another size along each axis.
inline model::mesh::SurfaceMesh make_ellipsoid(const model::Vec3& half_m, int levels,
                                               bool faces_inward = false) {
  const model::mesh::SurfaceMesh ball =
      faces_inward ? make_bowl(1.0, levels) : make_ball(1.0, levels);
  std::vector<model::Vec3> v = ball.vertex_m;
  for (model::Vec3& p : v) p = {p.x * half_m.x, p.y * half_m.y, p.z * half_m.z};
  return *model::mesh::make_surface_mesh(std::move(v), ball.triangle);
}

/// A hollow shell: an outer surface, and an inner one that faces the cavity.
inline model::mesh::SurfaceMesh make_bladder(const model::Vec3& half_m, double wall_m, int levels) {
  return join(make_ellipsoid(half_m, levels),
              make_ellipsoid(half_m - model::Vec3{wall_m, wall_m, wall_m}, levels, true));
}

/// A surface and what contact searches it by: made once for many bodies.
struct ContactSurface {
  explicit ContactSurface(model::mesh::SurfaceMesh m) : mesh(std::move(m)) {}

  model::mesh::SurfaceMesh mesh;
  model::contact::TriangleTree tree = model::contact::make_triangle_tree(mesh.view());
};

/// One elastic law everywhere on a surface, and the spheres of a tool.
struct SoftBody {
  SoftBody(const ContactSurface& on, std::vector<model::contact::ProbeSphere> s, double friction)
      : surface(on),
        spheres(std::move(s)),
        parameters{.friction_ratio = friction,
                   .sliding_stiffness_N_per_m = friction > 0.0 ? 20.0 : 0.0,
                   .tear_force_N = 1.0} {}
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;

  model::contact::ContactScene contact_scene() {
    model::contact::ContactScene scene;
    scene.law = &field;
    scene.parameters = parameters;
    scene.spheres = spheres;
    scene.surface = surface.mesh.view();
    scene.tree = surface.tree.view();
    scene.period_s = period_s;
    return scene;
  }
  double limit_N() const { return curve.respond(kRange_m).force_N; }
  double max_slope_N_per_m() const { return field.stiffest_N_per_m({}, false); }
  model::tissue::ElasticNeighbours neighbours() const {
    if (spheres.size() < 2) return {};
    return {.youngs_modulus_Pa = tip.youngs_modulus_Pa,
            .contact_modulus_Pa = tip.contact_modulus_Pa(),
            .poisson_ratio = tip.poisson_ratio};
  }

  static constexpr double kRange_m = 12e-3;
  double period_s = 1e-3;
  const ContactSurface& surface;
  std::vector<model::contact::ProbeSphere> spheres;
  model::contact::ContactParameters parameters;
  model::indent::ElasticTip tip{
      .youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = spheres[0].radius_m};
  std::vector<double> flat{0.0};
  model::indent::ComplianceCurve curve = *model::indent::make_compliance_curve(
      {.tip = tip, .working_depth_m = kRange_m, .ring_pitch_m = 2e-3, .ring_m_per_N = flat});
  const model::law::Law* law = &curve;
  model::tissue::ElasticField field{{.curves = {&law, 1},
                                     .coordinate = {},
                                     .pull_coordinate = {},
                                     .surface = {},
                                     .relaxation = {},
                                     .neighbours = neighbours()}};
};

}  // namespace tact::tests
