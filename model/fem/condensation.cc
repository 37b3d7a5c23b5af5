// SPDX-License-Identifier: Apache-2.0
#include "model/fem/condensation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/fem/hertz_load.h"
#include "model/fem/linear_solver.h"
#include "model/indent/compliance_law.h"
#include "model/scene/compliance_file.h"

namespace tact::model::fem {
namespace {

// The step of surface_hash(): what a mesh tool rounds is still the same place.
constexpr double kSamePlace_m = 1e-7;
constexpr std::size_t kAxes = 3;             // normal, two tangential
constexpr std::size_t kVerticesAtOnce = 21;  // three loads each: LinearSolver::solve()

/// What a solve says of one vertex, as floats: the rest at a normal load, along the surface, rings.
constexpr std::size_t kSidewaysFloats = sizeof(tissue::SidewaysCompliance) / sizeof(float);

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
  /// What one solve needs.
  struct Block {
    std::array<Frame, kVerticesAtOnce> frame{};
    std::array<std::vector<NodeWeight>, kVerticesAtOnce> patch;
    std::vector<std::vector<NodeLoad>> loads{kVerticesAtOnce * kAxes};
    std::vector<std::vector<Vec3>> moved_m{kVerticesAtOnce * kAxes};
  };

  std::size_t floats() const { return 1 + kSidewaysFloats + settings_.rings; }
  void solve(std::span<const std::uint32_t> vertices, std::span<float> out);
  void load(Block& block, std::size_t slot, std::uint32_t vertex) const;
  void read(const Block& block, std::size_t slot, std::uint32_t vertex, std::span<float> out) const;
  void read_rings(const Block& block, std::size_t slot, std::uint32_t vertex,
                  std::span<float> ring) const;
  const Vec3& moved(const Block& block, std::size_t slot, std::size_t axis,
                    std::uint32_t node) const {
    return block.moved_m[slot * kAxes + axis][place_in_skin_[node]];
  }

  const TetMesh& body_;
  const contact::SurfaceView& surface_;
  const CondensationSettings& settings_;
  Boundary boundary_;
  LinearSolver solver_;
  std::vector<std::uint32_t> skin_, place_in_skin_;
  std::vector<Vec3> skin_normal_;
  // At E = 1 Pa a compliance is that times E, as the map has it.
  Elasticity unit_{.youngs_modulus_Pa = 1.0, .poisson_ratio = settings_.poisson_ratio};
};

// The patch of a vertex and its three unit loads.
void Condenser::load(Block& block, std::size_t slot, std::uint32_t vertex) const {
  block.frame[slot] = frame_of(surface_.vertex_normal[vertex]);
  block.patch[slot] = hertz_weights(body_, boundary_, vertex, settings_.patch_radius_m);
  for (std::size_t q = 0; q < kAxes; ++q)
    for (const NodeWeight& w : block.patch[slot])
      block.loads[slot * kAxes + q].push_back({w.node, w.weight * block.frame[slot].axis[q]});
}

void Condenser::read(const Block& block, std::size_t slot, std::uint32_t vertex,
                     std::span<float> out) const {
  const Frame& frame = block.frame[slot];
  std::array<std::array<double, kAxes>, kAxes> c{};
  for (std::size_t p = 0; p < kAxes; ++p)
    for (std::size_t q = 0; q < kAxes; ++q)
      for (const NodeWeight& w : block.patch[slot])  // C_pq = sum w_a e_p . u_a^(q)
        c[p][q] += w.weight * dot(frame.axis[p], moved(block, slot, q, w.node));
  // Less the half-space under the same patch: the part that knows only the patch cancels.
  const double side = hertz_tangential_m_per_N(unit_, settings_.patch_radius_m);
  const double r = c[0][0] - hertz_normal_m_per_N(unit_, settings_.patch_radius_m);
  out[0] = static_cast<float>(r);
  // Turn the tangential axes until c12 = 0: tan(2 angle) = 2 c12 / (c11 - c22).
  const double c11 = c[1][1] - side, c22 = c[2][2] - side, c12 = c[1][2];
  const double angle = 0.5 * std::atan2(2.0 * c12, c11 - c22);
  const double u = std::cos(angle), v = std::sin(angle);
  const Vec3 axis = u * frame.axis[1] + v * frame.axis[2];
  const tissue::SidewaysCompliance sideways{
      .n1 = static_cast<float>(u * c[0][1] + v * c[0][2]),
      .n2 = static_cast<float>(u * c[0][2] - v * c[0][1]),
      .s1 = static_cast<float>(u * u * c11 + 2.0 * u * v * c12 + v * v * c22),
      .s2 = static_cast<float>(v * v * c11 - 2.0 * u * v * c12 + u * u * c22),
      .axis = {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)}};
  const auto reported = std::bit_cast<std::array<float, kSidewaysFloats>>(sideways);
  std::copy(reported.begin(), reported.end(), out.begin() + 1);
  read_rings(block, slot, vertex, out.subspan(1 + kSidewaysFloats));
}

void Condenser::read_rings(const Block& block, std::size_t slot, std::uint32_t vertex,
                           std::span<float> ring) const {
  std::array<double, indent::kMaxComplianceRings + 2> sum{}, weights{};
  const Vec3& n = block.frame[slot].axis[0];
  for (std::uint32_t i = 0; i < skin_.size(); ++i) {
    const double rho_m = norm(body_.node_m[skin_[i]] - body_.node_m[vertex]);
    const double at = rho_m / settings_.ring_pitch_m;
    if (at >= static_cast<double>(ring.size() + 1) || dot(skin_normal_[i], n) < contact::kFacing)
      continue;
    const double g = dot(n, moved(block, slot, 0, skin_[i])) -
                     hertz_displacement_m_per_N(unit_, settings_.patch_radius_m, rho_m);
    // A hat a ring: a node between two rings counts for both, by its nearness.
    const auto low = static_cast<std::size_t>(at);
    const double high_share = at - static_cast<double>(low);
    sum[low] += (1.0 - high_share) * g, weights[low] += 1.0 - high_share;
    sum[low + 1] += high_share * g, weights[low + 1] += high_share;
  }
  // at rho = 0, should no skin beside it count
  double before = dot(n, moved(block, slot, 0, vertex)) -
                  hertz_displacement_m_per_N(unit_, settings_.patch_radius_m, 0.0);
  // Chosen: a ring of less than a thousandth of a node has no skin.
  if (weights[0] > 1e-3) before = sum[0] / weights[0];
  for (std::size_t j = 1; j <= ring.size(); ++j) {
    if (weights[j] > 1e-3) before = sum[j] / weights[j];  // beyond an edge: as the last ring
    ring[j - 1] = static_cast<float>(before);
  }
}

// A vertex whose patch is empty stays NaN: no point of the sum fell into it, its weights would be
// 0/0.
void Condenser::solve(std::span<const std::uint32_t> vertices, std::span<float> out) {
  Block block;
  for (std::size_t slot = 0; slot < vertices.size(); ++slot) load(block, slot, vertices[slot]);
  const std::span<const std::vector<NodeLoad>> loads(block.loads.data(), vertices.size() * kAxes);
  solver_.solve(loads, skin_, block.moved_m);
  for (std::size_t slot = 0; slot < vertices.size(); ++slot) {
    const std::span<float> reported = out.subspan(slot * floats(), floats());
    reported[0] = std::numeric_limits<float>::quiet_NaN();
    if (!block.patch[slot].empty()) read(block, slot, vertices[slot], reported);
  }
}

std::optional<Error> Condenser::run(tissue::ComplianceMap& map) {
  std::vector<std::uint32_t> vertices(surface_.vertex_m.size());
  std::iota(vertices.begin(), vertices.end(), 0U);
  // Near each other in the elimination, so that their loads reach the same few columns of L.
  std::sort(vertices.begin(), vertices.end(), [this](std::uint32_t a, std::uint32_t b) {
    return solver_.place_of(a) < solver_.place_of(b);
  });
  const std::size_t blocks = (vertices.size() + kVerticesAtOnce - 1) / kVerticesAtOnce;
  std::vector<float> reported(blocks * kVerticesAtOnce * floats());
  const auto work = [&](std::size_t k, std::span<float> out) {
    const std::size_t first = k * kVerticesAtOnce;
    const std::size_t here = std::min(kVerticesAtOnce, vertices.size() - first);
    solve(std::span(vertices).subspan(first, here), out);
  };
  if (auto error = settings_.run_jobs(blocks, reported, work)) return error;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const float* one = reported.data() + i * floats();
    const std::uint32_t vertex = vertices[i];
    if (std::isnan(one[0]))
      return Error{fmt::format(
          "condensation: a patch of {:g} m is too small for the elements at vertex {}; make the "
          "patch wider or the elements finer",
          settings_.patch_radius_m, vertex)};
    map.regular_times_E_per_m[vertex] = one[0];
    std::array<float, kSidewaysFloats> sideways{};
    std::copy_n(one + 1, kSidewaysFloats, sideways.begin());
    map.sideways_times_E_per_m[vertex] = std::bit_cast<tissue::SidewaysCompliance>(sideways);
    std::copy_n(one + 1 + kSidewaysFloats, map.rings,
                map.ring_times_E_per_m.begin() + static_cast<std::ptrdiff_t>(vertex * map.rings));
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> one_after_the_other(std::size_t jobs, std::span<float> results,
                                         const Work& work) {
  const std::size_t each = results.size() / jobs;
  for (std::size_t job = 0; job < jobs; ++job) work(job, results.subspan(job * each, each));
  return std::nullopt;
}

Result<tissue::ComplianceMap> condense(const TetMesh& body, const contact::SurfaceView& surface,
                                       const CondensationSettings& settings) {
  if (const char* wrong = parameter_error(body, surface, settings))
    return Error{std::string("condensation: ") + wrong};
  Boundary boundary = find_boundary(body);
  const std::vector<std::uint32_t> fixed =
      nodes_of_faces_in_box(body, boundary, settings.fixed_min_m, settings.fixed_max_m);
  if (fixed.empty())
    return Error{
        "condensation: no triangle of the surface lies in the held box, elastic.fixed_min_m to "
        "elastic.fixed_max_m; make it hold one"};
  auto solver = make_linear_solver(body, {1.0, settings.poisson_ratio, settings.lumps}, fixed);
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
