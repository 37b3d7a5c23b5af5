// SPDX-License-Identifier: Apache-2.0
// Any number of vertices on a smooth closed body: rings of latitude, zipped, then relaxed.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {
namespace {

using model::cross;
using model::dot;
using model::norm;
using model::Result;
using model::Vec3;
using model::contact::kNoTriangle;
using model::contact::TriangleCorners;
using model::mesh::SurfaceMesh;

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kSlices = 1024;  // samples of the body from pole to pole
constexpr std::size_t kSpokes = 256;   // samples round a ring
constexpr int kRelaxations = 30;
constexpr double kPull = 0.8;  // of the way to the centre of the fan, each time

// The poles are at -y and +y, the ends of a long body.
Vec3 on_sphere(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), -std::cos(polar_rad),
          -std::sin(polar_rad) * std::sin(azimuth_rad)};
}

// Way along a ring of the body after each spoke, mm; the last entry is its perimeter.
std::vector<double> ring_way_mm(const SphereMap& map, double polar_rad) {
  std::vector<double> way_mm{0.0};
  Vec3 last = map(on_sphere(polar_rad, 0.0));
  for (std::size_t i = 1; i <= kSpokes; ++i) {
    const Vec3 here = map(on_sphere(polar_rad, 2.0 * kPi * double(i) / kSpokes));
    way_mm.push_back(way_mm.back() + norm(here - last));
    last = here;
  }
  return way_mm;
}

// Where a rising table of equal steps passes `value`, in steps.
double place_of(double value, const std::vector<double>& table) {
  const auto above = std::upper_bound(table.begin() + 1, table.end() - 1, value);
  const double low = *(above - 1);
  return double(above - table.begin() - 1) + (value - low) / (*above - low);
}

struct Ring {
  double polar_rad = 0.0;
  std::size_t points = 0;
  std::uint32_t first = 0;  // vertex
  double turn = 0.0;        // of the first point, in point spacings
};

// The body from pole to pole, summed slice by slice.
struct Profile {
  std::vector<double> height_mm{0.0};  // mean way from the first pole
  double area_mm2 = 0.0;
};

Profile measure(const SphereMap& map) {
  constexpr std::size_t kWays = 16;
  Profile profile;
  double last_mm = 0.0;  // perimeter
  for (std::size_t i = 1; i <= kSlices; ++i) {
    const double polar_rad = kPi * double(i) / kSlices;
    double step_mm = 0.0;
    for (std::size_t way = 0; way < kWays; ++way) {
      const double azimuth_rad = 2.0 * kPi * double(way) / kWays;
      step_mm += norm(map(on_sphere(polar_rad, azimuth_rad)) -
                      map(on_sphere(polar_rad - kPi / kSlices, azimuth_rad))) /
                 kWays;
    }
    const double perimeter_mm = i == kSlices ? 0.0 : ring_way_mm(map, polar_rad).back();
    profile.height_mm.push_back(profile.height_mm.back() + step_mm);
    profile.area_mm2 += 0.5 * (perimeter_mm + last_mm) * step_mm;
    last_mm = perimeter_mm;
  }
  return profile;
}

// Ring distance h sqrt(3)/2 and point distance h, both measured on the body, make equilateral
// triangles; h follows from the area  A = V h^2 sqrt(3)/2.
std::vector<Ring> place_rings(std::size_t vertices, const SphereMap& map) {
  const Profile profile = measure(map);
  const double h_mm = std::sqrt(profile.area_mm2 / (double(vertices) * 0.5 * std::sqrt(3.0)));
  const double total_mm = profile.height_mm.back();
  const double rings = std::round(total_mm / (h_mm * 0.5 * std::sqrt(3.0))) - 1.0;
  std::vector<Ring> ring(static_cast<std::size_t>(rings));
  std::vector<double> until_mm;  // running sum of the perimeters
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const double at = place_of(total_mm * double(k + 1) / (rings + 1.0), profile.height_mm);
    ring[k].polar_rad = kPi * at / kSlices;
    const double perimeter_mm = ring_way_mm(map, ring[k].polar_rad).back();
    until_mm.push_back(perimeter_mm + (until_mm.empty() ? 0.0 : until_mm.back()));
  }
  // Rounding the running sum, not the parts, makes the rings hold exactly all but the two poles.
  std::size_t placed = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const double share = until_mm[k] / until_mm.back();
    const auto until = static_cast<std::size_t>(std::lround(double(vertices - 2) * share));
    ring[k].points = until - placed;
    ring[k].first = static_cast<std::uint32_t>(placed + 1);
    ring[k].turn = k % 2 == 0 ? 0.0 : 0.5;
    placed = until;
  }
  return ring;
}

void fill_ring(const Ring& ring, const SphereMap& map, std::vector<Vec3>& on_unit) {
  const std::vector<double> way_mm = ring_way_mm(map, ring.polar_rad);
  for (std::size_t i = 0; i < ring.points; ++i) {
    const double here_mm = way_mm.back() * (double(i) + ring.turn) / double(ring.points);
    const double azimuth_rad = 2.0 * kPi * place_of(here_mm, way_mm) / kSpokes;
    on_unit[ring.first + i] = on_sphere(ring.polar_rad, azimuth_rad);
  }
}

// Triangles between two rings, stepping on whichever ring lies behind.
void zip(const Ring& a, const Ring& b, std::vector<TriangleCorners>& triangle) {
  const auto vertex = [](const Ring& r, std::size_t i) {
    return r.first + static_cast<std::uint32_t>(i % r.points);
  };
  const auto angle = [](const Ring& r, std::size_t i) {
    return (double(i) + r.turn) / double(r.points);
  };
  std::size_t i = 0, j = 0;
  while (i < a.points || j < b.points) {
    const bool step_a = j == b.points || (i < a.points && angle(a, i) + angle(a, i + 1) <
                                                              angle(b, j) + angle(b, j + 1));
    if (step_a) {
      triangle.push_back({vertex(a, i), vertex(a, i + 1), vertex(b, j)});
      ++i;
    } else {
      triangle.push_back({vertex(a, i), vertex(b, j + 1), vertex(b, j)});
      ++j;
    }
  }
}

std::vector<TriangleCorners> zip_rings(const std::vector<Ring>& ring, std::uint32_t last_vertex) {
  std::vector<TriangleCorners> triangle;
  for (std::uint32_t i = 0; i < ring.front().points; ++i) {
    const auto next = static_cast<std::uint32_t>((i + 1) % ring.front().points);
    triangle.push_back({0, ring.front().first + next, ring.front().first + i});
  }
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) zip(ring[k], ring[k + 1], triangle);
  for (std::uint32_t i = 0; i < ring.back().points; ++i) {
    const auto next = static_cast<std::uint32_t>((i + 1) % ring.back().points);
    triangle.push_back({last_vertex, ring.back().first + i, ring.back().first + next});
  }
  return triangle;
}

std::size_t edge_to(const TriangleCorners& across, std::uint32_t triangle) {
  return across[0] == triangle ? 0 : across[1] == triangle ? 1 : 2;
}

// Replace the diagonal a-b of the quad a, d, b, c by c-d, where it is the better one.
class Flipper {
 public:
  explicit Flipper(SurfaceMesh& mesh) : mesh_(mesh), valence_(mesh.vertex_m.size(), 0) {
    for (const TriangleCorners& t : mesh.triangle)
      for (const std::uint32_t v : t) ++valence_[v];
  }

  void pass(const std::vector<Vec3>& p) {
    for (std::uint32_t t = 0; t < mesh_.triangle.size(); ++t)
      for (std::size_t e = 0; e < 3; ++e) flip_if_better(p, t, e);
  }

 private:
  static double cotangent(const Vec3& tip, const Vec3& a, const Vec3& b) {
    return dot(a - tip, b - tip) / norm(cross(a - tip, b - tip));
  }

  void flip_if_better(const std::vector<Vec3>& p, std::uint32_t t, std::size_t e) {
    const std::uint32_t u = mesh_.neighbour[t][e];
    TriangleCorners& near = mesh_.triangle[t];
    TriangleCorners& far = mesh_.triangle[u];
    const std::size_t f = edge_to(mesh_.neighbour[u], t);
    const std::uint32_t a = near[e], b = near[(e + 1) % 3], c = near[(e + 2) % 3];
    const std::uint32_t d = far[(f + 2) % 3];
    if (valence_[a] <= 4 || valence_[b] <= 4) return;
    // Delaunay: the angles that face the edge add up to at most 180 degrees, cot c + cot d >= 0.
    if (cotangent(p[c], p[a], p[b]) + cotangent(p[d], p[a], p[b]) > -1e-9) return;
    const std::uint32_t bc = mesh_.neighbour[t][(e + 1) % 3], ca = mesh_.neighbour[t][(e + 2) % 3];
    const std::uint32_t ad = mesh_.neighbour[u][(f + 1) % 3], db = mesh_.neighbour[u][(f + 2) % 3];
    near = {a, d, c};
    far = {d, b, c};
    mesh_.neighbour[t] = {ad, u, ca};
    mesh_.neighbour[u] = {db, bc, t};
    mesh_.neighbour[ad][edge_to(mesh_.neighbour[ad], u)] = t;
    mesh_.neighbour[bc][edge_to(mesh_.neighbour[bc], t)] = u;
    --valence_[a], --valence_[b], ++valence_[c], ++valence_[d];
  }

  SurfaceMesh& mesh_;
  std::vector<int> valence_;
};

// Pull each vertex towards the centre of its fan, weighted with areas on the body. Centres are
// affine, so the step may be taken on the sphere, and the vertex stays on the body exactly.
void relax(const SurfaceMesh& mesh, const std::vector<Vec3>& p_mm, std::vector<Vec3>& on_unit) {
  std::vector<Vec3> sum(on_unit.size());
  std::vector<double> weight(on_unit.size(), 0.0);
  for (const TriangleCorners& t : mesh.triangle) {
    const double area = norm(cross(p_mm[t[1]] - p_mm[t[0]], p_mm[t[2]] - p_mm[t[0]]));
    const Vec3 centre = (on_unit[t[0]] + on_unit[t[1]] + on_unit[t[2]]) / 3.0;
    for (const std::uint32_t v : t) {
      sum[v] += area * centre;
      weight[v] += area;
    }
  }
  for (std::size_t v = 0; v < on_unit.size(); ++v) {
    const Vec3 centre = sum[v] / weight[v];
    on_unit[v] = normalized(on_unit[v] + kPull * (centre - on_unit[v]));
  }
}

}  // namespace

Result<Shape> make_body(std::size_t vertices, const SphereMap& map) {
  if (vertices < kMinVertices) return model::Error{"a body needs at least 50 vertices"};
  const std::vector<Ring> ring = place_rings(vertices, map);
  std::vector<Vec3> on_unit(vertices);
  on_unit.front() = on_sphere(0.0, 0.0);
  on_unit.back() = {0.0, 1.0, 0.0};
  for (const Ring& r : ring) fill_ring(r, map, on_unit);

  Shape shape;
  shape.vertex_mm.resize(vertices);
  const auto place = [&] {
    std::transform(on_unit.begin(), on_unit.end(), shape.vertex_mm.begin(), map);
  };
  place();
  Result<SurfaceMesh> mesh = model::mesh::make_surface_mesh(
      shape.vertex_mm, zip_rings(ring, static_cast<std::uint32_t>(vertices - 1)));
  if (!mesh) return mesh.error();
  Flipper flipper(*mesh);
  for (int i = 0; i < kRelaxations; ++i) {
    flipper.pass(shape.vertex_mm);
    relax(*mesh, shape.vertex_mm, on_unit);
    place();
  }
  for (int i = 0; i < 3; ++i) flipper.pass(shape.vertex_mm);
  shape.triangle = std::move(mesh->triangle);
  return shape;
}

double least_angle_deg(const Shape& shape) {
  double least_rad = kPi;
  for (const TriangleCorners& t : shape.triangle) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 a = shape.vertex_mm[t[(e + 1) % 3]] - shape.vertex_mm[t[e]];
      const Vec3 b = shape.vertex_mm[t[(e + 2) % 3]] - shape.vertex_mm[t[e]];
      least_rad = std::min(least_rad, std::atan2(norm(cross(a, b)), dot(a, b)));
    }
  }
  return least_rad * 180.0 / kPi;
}

}  // namespace tact::tools::make_meshes
