// SPDX-License-Identifier: Apache-2.0
#include "model/fem/condensation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "model/fem/hertz_load.h"
#include "model/fem/linear_solver.h"
#include "model/indent/compliance_law.h"
#include "model/scene/compliance_file.h"

namespace tact::model::fem {
namespace {

// The step of surface_hash(): what a mesh tool rounds is still the same place.
constexpr double kSamePlace_m = 1e-7;
constexpr std::size_t kAxes = 3;  // normal, two tangential
// Three loads a vertex: five vertices fill 15 of the 16 columns of a solve.
constexpr std::size_t kVerticesAtOnce = kLoadsAtOnce / kAxes;

struct Frame {
  std::array<Vec3, kAxes> axis{};  // n, t1, t2
};

// n and any two axes along the surface; read() turns them.
Frame frame_of(const Vec3& n) {
  // Whichever axis is not near n.
  const Vec3 other = std::abs(n.x) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 t1 = normalized(cross(n, other));
  return {{n, t1, cross(n, t1)}};
}

const char* parameter_error(const TetMesh& body, const contact::SurfaceView& surface,
                            const CondensationSettings& s) {
  if (!(s.patch_radius_m > 0.0)) return "patch_radius_m must be above 0";
  if (!(s.ring_pitch_m > 0.0)) return "ring_pitch_m must be above 0";
  if (s.rings < 1 || s.rings > indent::kMaxComplianceRings)
    return "rings must lie between 1 and 31";
  if (body.node_m.size() < surface.vertex_m.size())
    return "the body has fewer nodes than the surface has vertices";
  for (std::size_t v = 0; v < surface.vertex_m.size(); ++v)
    if (!(norm(body.node_m[v] - surface.vertex_m[v]) < kSamePlace_m))
      return "the body's first nodes are not the vertices of the surface";
  return nullptr;
}

class Condenser {
 public:
  Condenser(const TetMesh& body, const contact::SurfaceView& surface,
            const CondensationSettings& settings, Boundary boundary, LinearSolver solver)
      : body_(body),
        surface_(surface),
        settings_(settings),
        boundary_(std::move(boundary)),
        solver_(std::move(solver)),
        skin_(skin_nodes(boundary_)) {
    place_in_skin_.resize(body.node_m.size());
    for (std::uint32_t i = 0; i < skin_.size(); ++i) place_in_skin_[skin_[i]] = i;
    for (const std::uint32_t node : skin_) {
      Vec3 sum{};
      for (const std::uint32_t f : boundary_.faces_of_node[node]) sum += boundary_.normal[f];
      skin_normal_.push_back(normalized(sum));
    }
  }

  std::optional<Error> run(tissue::ComplianceMap& map);

 private:
  void load(std::size_t slot, std::uint32_t vertex);
  void read(std::size_t slot, std::uint32_t vertex, tissue::ComplianceMap& map) const;
  void read_rings(std::size_t slot, std::uint32_t vertex, std::span<float> ring) const;
  const Vec3& moved(std::size_t slot, std::size_t axis, std::uint32_t node) const {
    return moved_m_[slot * kAxes + axis][place_in_skin_[node]];
  }

  const TetMesh& body_;
  const contact::SurfaceView& surface_;
  const CondensationSettings& settings_;
  Boundary boundary_;
  LinearSolver solver_;
  std::vector<std::uint32_t> skin_, place_in_skin_;
  std::vector<Vec3> skin_normal_;
  std::array<Frame, kVerticesAtOnce> frame_{};
  std::array<std::vector<NodeWeight>, kVerticesAtOnce> patch_;
  std::vector<std::vector<NodeLoad>> loads_{kVerticesAtOnce * kAxes};
  std::vector<std::vector<Vec3>> moved_m_{kVerticesAtOnce * kAxes};
  // At E = 1 Pa a compliance is that times E, as the map has it.
  Elasticity unit_{.youngs_modulus_Pa = 1.0, .poisson_ratio = settings_.poisson_ratio};
};

// The patch of a vertex and its three unit loads.
void Condenser::load(std::size_t slot, std::uint32_t vertex) {
  frame_[slot] = frame_of(surface_.vertex_normal[vertex]);
  patch_[slot] = hertz_weights(body_, boundary_, vertex, settings_.patch_radius_m);
  for (std::size_t q = 0; q < kAxes; ++q) {
    auto& load = loads_[slot * kAxes + q];
    load.clear();
    for (const NodeWeight& w : patch_[slot])
      load.push_back({w.node, w.weight * frame_[slot].axis[q]});
  }
}

// What the solve says of that vertex goes into the map.
void Condenser::read(std::size_t slot, std::uint32_t vertex, tissue::ComplianceMap& map) const {
  std::array<std::array<double, kAxes>, kAxes> c{};
  for (std::size_t p = 0; p < kAxes; ++p)
    for (std::size_t q = 0; q < kAxes; ++q)
      for (const NodeWeight& w : patch_[slot])  // C_pq = sum w_a e_p . u_a^(q)
        c[p][q] += w.weight * dot(frame_[slot].axis[p], moved(slot, q, w.node));
  // Less the half-space under the same patch: the part that knows only the patch cancels.
  const double side = hertz_tangential_m_per_N(unit_, settings_.patch_radius_m);
  const double r = c[0][0] - hertz_normal_m_per_N(unit_, settings_.patch_radius_m);
  map.regular_times_E_per_m[vertex] = static_cast<float>(r);
  // Turn the tangential axes until c12 = 0: tan(2 angle) = 2 c12 / (c11 - c22).
  const double c11 = c[1][1] - side, c22 = c[2][2] - side, c12 = c[1][2];
  const double angle = 0.5 * std::atan2(2.0 * c12, c11 - c22);
  const double u = std::cos(angle), v = std::sin(angle);
  const Vec3 axis = u * frame_[slot].axis[1] + v * frame_[slot].axis[2];
  map.sideways_times_E_per_m[vertex] = {
      .n1 = static_cast<float>(u * c[0][1] + v * c[0][2]),
      .n2 = static_cast<float>(u * c[0][2] - v * c[0][1]),
      .s1 = static_cast<float>(u * u * c11 + 2.0 * u * v * c12 + v * v * c22),
      .s2 = static_cast<float>(v * v * c11 - 2.0 * u * v * c12 + u * u * c22),
      .axis = {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)}};
  read_rings(slot, vertex,
             {map.ring_times_E_per_m.data() + std::size_t{vertex} * map.rings, map.rings});
}

void Condenser::read_rings(std::size_t slot, std::uint32_t vertex, std::span<float> ring) const {
  std::array<double, indent::kMaxComplianceRings + 2> sum{}, weights{};
  const Vec3& n = frame_[slot].axis[0];
  for (std::uint32_t i = 0; i < skin_.size(); ++i) {
    const double rho_m = norm(body_.node_m[skin_[i]] - body_.node_m[vertex]);
    const double at = rho_m / settings_.ring_pitch_m;
    if (at >= static_cast<double>(ring.size() + 1) || dot(skin_normal_[i], n) < contact::kFacing)
      continue;
    const double g = dot(n, moved(slot, 0, skin_[i])) -
                     hertz_displacement_m_per_N(unit_, settings_.patch_radius_m, rho_m);
    // A hat a ring: a node between two rings counts for both, by its nearness.
    const auto low = static_cast<std::size_t>(at);
    const double high_share = at - static_cast<double>(low);
    sum[low] += (1.0 - high_share) * g, weights[low] += 1.0 - high_share;
    sum[low + 1] += high_share * g, weights[low + 1] += high_share;
  }
  // at rho = 0, should no skin beside it count
  double before = dot(n, moved(slot, 0, vertex)) -
                  hertz_displacement_m_per_N(unit_, settings_.patch_radius_m, 0.0);
  // Chosen: a ring of less than a thousandth of a node has no skin.
  if (weights[0] > 1e-3) before = sum[0] / weights[0];
  for (std::size_t j = 1; j <= ring.size(); ++j) {
    if (weights[j] > 1e-3) before = sum[j] / weights[j];  // beyond an edge: as the last ring
    ring[j - 1] = static_cast<float>(before);
  }
}

std::optional<Error> Condenser::run(tissue::ComplianceMap& map) {
  const auto stopped = [] { return Error{"condensation: stopped"}; };
  const auto count = static_cast<std::uint32_t>(surface_.vertex_m.size());
  for (std::uint32_t first = 0; first < count; first += kVerticesAtOnce) {
    if (settings_.progress && !settings_.progress(first, count)) return stopped();
    const std::uint32_t here = std::min(static_cast<std::uint32_t>(kVerticesAtOnce), count - first);
    for (std::uint32_t slot = 0; slot < here; ++slot) {
      load(slot, first + slot);
      // No point of the sum fell into the patch: its weights would be 0/0.
      if (patch_[slot].empty())
        return Error{fmt::format(
            "condensation: a patch of {:g} m is too small for the elements at vertex {}; make the "
            "patch wider or the elements finer",
            settings_.patch_radius_m, first + slot)};
    }
    solver_.solve({loads_.data(), here * kAxes}, skin_, moved_m_);
    for (std::uint32_t slot = 0; slot < here; ++slot) read(slot, first + slot, map);
  }
  if (settings_.progress && !settings_.progress(count, count)) return stopped();
  return std::nullopt;
}

}  // namespace

Result<tissue::ComplianceMap> condense(const TetMesh& body, const contact::SurfaceView& surface,
                                       const CondensationSettings& settings) {
  if (const char* wrong = parameter_error(body, surface, settings))
    return Error{std::string("condensation: ") + wrong};
  if (settings.progress && !settings.progress(0, surface.vertex_m.size()))
    return Error{"condensation: stopped"};
  Boundary boundary = find_boundary(body);
  const std::vector<std::uint32_t> fixed =
      nodes_of_faces_in_box(body, boundary, settings.fixed_min_m, settings.fixed_max_m);
  if (fixed.empty())
    return Error{
        "condensation: no triangle of the surface lies in the held box, elastic.fixed_min_m to "
        "elastic.fixed_max_m; make it hold one"};
  auto solver = make_linear_solver(body, {1.0, settings.poisson_ratio}, fixed);
  if (!solver) return solver.error();
  const std::size_t n = surface.vertex_m.size();
  tissue::ComplianceMap map{.poisson_ratio = settings.poisson_ratio,
                            .patch_radius_m = settings.patch_radius_m,
                            .ring_pitch_m = settings.ring_pitch_m,
                            .rings = settings.rings,
                            .fixed_min_m = settings.fixed_min_m,
                            .fixed_max_m = settings.fixed_max_m,
                            .mesh_hash = scene::surface_hash(surface)};
  map.regular_times_E_per_m.resize(n);
  map.sideways_times_E_per_m.resize(n);
  map.ring_times_E_per_m.resize(n * settings.rings);
  Condenser condenser(body, surface, settings, std::move(boundary), std::move(*solver));
  if (auto failed = condenser.run(map)) return *failed;
  return map;
}

}  // namespace tact::model::fem
