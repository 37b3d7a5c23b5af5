// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_patch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "model/ranges.h"
#include "model/springs/spring_step_check.h"

namespace tact::model::springs {
namespace {

// What moved by less than a micrometre is not seen. Cut edges get half of
// the room at most, or an old cut would hide the contact.
constexpr double kShownMove_m = 1e-6;
constexpr double kLostIndentations =
    10.0;  // an indentation of so many working depths is no tissue any more
constexpr std::size_t kShownCutEdges = contact::kMaxShapeNodes / 2;

// F_s = -F grad w;  grad w = n x (sum of w_i (edge opposite i)) / (2 area)
Vec3 slope_N(const contact::SurfaceView& mesh, const contact::TriangleCorners& corner,
             const std::array<double, 3>& indentation_m, double force_N) RT_SAFE {
  const Vec3 &a = mesh.vertex_m[corner[0]], &b = mesh.vertex_m[corner[1]],
             &c = mesh.vertex_m[corner[2]];
  const Vec3 twice_area = cross(b - a, c - a);
  const Vec3 turn =
      indentation_m[0] * (c - b) + indentation_m[1] * (a - c) + indentation_m[2] * (b - a);
  return (-force_N / dot(twice_area, twice_area)) * cross(twice_area, turn);
}

StepRule rule_of(const SpringPatchParameters& p) RT_SAFE {
  return {.method = p.method,
          .step_s = p.tick_s / static_cast<double>(p.substeps),
          .iterations = static_cast<int>(p.iterations)};
}

/// The whole mesh as one network, to ask whether any part of it could blow up.
std::optional<Error> check_everywhere(const PatchSurface& surface, const SpringPatchParameters& p) {
  const std::size_t n = surface.mesh.vertex_m.size();
  std::vector<Vec3> rest(surface.mesh.vertex_m.begin(), surface.mesh.vertex_m.end());
  std::vector<Vec3> velocity(n);
  std::vector<double> inverse(n, 1.0 / p.node_mass_kg), drag;
  drag.reserve(n);
  for (const double a : surface.anchor_N_per_m) drag.push_back(p.tissue.body_damping_time_s * a);
  std::vector<Spring> springs;
  springs.reserve(surface.edge.size());
  const double k = p.tissue.surface_stiffness_N_per_m;
  for (const PatchEdge& e : surface.edge)
    springs.push_back({e.a, e.b, k, p.tissue.damping_time_s * k, surface.rest_length_m(e)});
  const SpringNetwork network{
      .node = {rest, velocity, rest, surface.load_N, inverse, surface.anchor_N_per_m, drag},
      .spring = springs,
      .probe = {}};
  return check_step(
      network, rule_of(p),
      {.stiffness_N_per_m = static_cast<double>(p.spheres) * p.coupling_stiffness_N_per_m,
       .damping_time_s = p.tissue.damping_time_s});
}

}  // namespace

SpringPatch::SpringPatch(PatchSurface surface, const SpringPatchParameters& parameters)
    : parameters_(parameters),
      region_(std::move(surface), parameters.node_mass_kg, parameters.nodes, parameters.relaxation),
      stepper_(region_.capacity(), region_.spring_capacity()) {
  gathered_.fill(contact::kNoTriangle);
  double sum_m = 0.0;
  for (const PatchEdge& e : region_.surface().edge) sum_m += e.length_m;
  ring_pitch_m_ = sum_m / static_cast<double>(region_.surface().edge.size());
}

Result<std::unique_ptr<SpringPatch>> make_spring_patch(const contact::SurfaceView& surface,
                                                       const SpringPatchParameters& p) {
  if (auto wrong = check_meaning("spring patch", p)) return *wrong;
  if (!is_positive(p.tick_s)) return Error{"spring patch: tick_s must be finite and above 0"};
  if (p.spheres < 1 || p.spheres > contact::kMaxSpheres)
    return Error{"spring patch: spheres must lie between 1 and " +
                 std::to_string(contact::kMaxSpheres)};
  if (surface.triangle.empty()) return Error{"spring patch: the surface has no triangles"};
  if (const auto vertex = crowded_vertex(surface))
    return Error{"spring patch: vertex " + std::to_string(*vertex) + " has " +
                 std::to_string(kMaxPatchDegree) + " triangles or more; remesh the surface there"};
  PatchSurface springs = make_patch_surface(surface, p.tissue);
  if (auto failed = check_everywhere(springs, p)) return *failed;
  SpringPatchParameters fitted = p;
  fitted.nodes = std::min(p.nodes, surface.vertex_m.size());
  return std::unique_ptr<SpringPatch>(new SpringPatch(std::move(springs), fitted));
}

std::size_t SpringPatch::memory_bytes() const {
  return sizeof *this + region_.memory_bytes() + stepper_.memory_bytes();
}

// Broken tissue stays so until the tool is out of contact: a fresh patch would kick.
void SpringPatch::leave(std::size_t sphere) RT_SAFE {
  if (sphere >= contact::kMaxSpheres) return;
  contact_[sphere] = {};
  if (organ() != nullptr) organ()->leave(sphere);
  if (std::none_of(contact_.begin(), contact_.end(), [](const SphereState& t) { return t.active; }))
    broke_ = false;
}

contact::ContactLawResponse SpringPatch::respond(const contact::Indentation& in) RT_SAFE {
  if (in.sphere >= contact::kMaxSpheres) return {.law = {.status = law::LawStatus::kInvalid}};
  // Input that gives no force below is not stepped either.
  SphereState& sphere_contact = contact_[in.sphere];
  sphere_contact = {};
  const contact::SurfaceView& mesh = region_.surface().mesh;
  if (!std::isfinite(in.indentation_m) || !is_on_surface(in.surface_point, mesh))
    return {.law = {.status = law::LawStatus::kInvalid}};
  if (in.indentation_m <= 0.0 && !in.held) return {.law = {.status = law::LawStatus::kNoContact}};
  const double limit_m = parameters_.working_depth_m;
  const double depth_m = std::clamp(in.indentation_m, -limit_m, limit_m);
  sphere_contact = {
      .active = true, .held = in.held, .depth_m = depth_m, .surface_point = in.surface_point};
  if (broke_) return {.law = {.status = law::LawStatus::kSingular}};
  if (organ() != nullptr) return organ()->respond(in);

  const contact::TriangleCorners& corner = mesh.triangle[in.surface_point.triangle];
  std::array<double, 3> indentation{};
  double w_m = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    indentation[c] = -dot(mesh.vertex_normal[corner[c]], region_.moved_m(corner[c]));
    w_m += in.surface_point.weight[c] * indentation[c];
  }
  const double q = parameters_.coupling_stiffness_N_per_m;
  if (!(std::abs(w_m) <= kLostIndentations * limit_m)) {
    give_up();
    return {.law = {.status = law::LawStatus::kSingular}};
  }
  // Without a grip the virtual spring never pulls.
  const double stretch_m = in.held ? depth_m - w_m : std::max(depth_m - w_m, 0.0);
  contact::ContactLawResponse out{
      .law = {.force_N = q * stretch_m,
              .stiffness_N_per_m = stretch_m != 0.0 ? q : 0.0,
              .energy_J = 0.5 * q * stretch_m * stretch_m + network_energy_J_,
              .status = law::LawStatus::kOk}};
  if (depth_m != in.indentation_m) {
    out.law.energy_J += out.law.force_N * (in.indentation_m - depth_m);
    out.law.stiffness_N_per_m = 0.0;
    out.law.status = law::LawStatus::kSaturated;
  }
  out.slope_N = slope_N(mesh, corner, indentation, out.law.force_N);
  return out;
}

double SpringPatch::resistance_N(const contact::Indentation& in, double force_N) const RT_SAFE {
  return organ() != nullptr ? organ()->resistance_N(in, force_N) : 0.0;
}

contact::ContactCoupling SpringPatch::coupling(const contact::Indentation& a,
                                               const contact::Indentation& b,
                                               double distance_m) const RT_SAFE {
  return organ() != nullptr ? organ()->coupling(a, b, distance_m) : contact::ContactCoupling{};
}

double SpringPatch::stiffest_N_per_m(const contact::SurfacePoint& surface_point,
                                     bool held) const RT_SAFE {
  return organ() != nullptr ? organ()->stiffest_N_per_m(surface_point, held) : 0.0;
}

double SpringPatch::relaxation_ratio() const RT_SAFE {
  return organ() != nullptr ? organ()->relaxation_ratio() : 0.0;
}

// 1 / q + that of the place: linear over each triangle.
contact::TangentCompliance SpringPatch::tangent_compliance(
    const contact::SurfacePoint& surface_point, bool held,
    const contact::Axes& axes) const RT_SAFE {
  if (organ() != nullptr) return organ()->tangent_compliance(surface_point, held, axes);
  const PatchSurface& surface = region_.surface();
  if (!is_on_surface(surface_point, surface.mesh)) return {};
  double compliance_m_per_N = 1.0 / parameters_.coupling_stiffness_N_per_m;
  for (std::size_t c = 0; c < 3; ++c)
    compliance_m_per_N +=
        surface_point.weight[c] *
        surface.sideways_m_per_N[surface.mesh.triangle[surface_point.triangle][c]];
  return {.rest_m_per_N = {.xx = compliance_m_per_N, .yy = compliance_m_per_N}};
}

// A triangle near the rim, or out of the region, gathers again, once for each triangle.
void SpringPatch::follow_contacts() RT_SAFE {
  std::array<std::uint32_t, contact::kMaxSpheres> triangle{};
  std::size_t count = 0;
  bool must_gather = false;
  for (std::size_t i = 0; i < parameters_.spheres; ++i) {
    if (!contact_[i].active) continue;
    const std::uint32_t t = contact_[i].surface_point.triangle;
    triangle[count++] = t;
    // In a very small region even the touched triangle is
    // at the rim: it must not gather in every tick.
    if (t != gathered_[i] && !region_.holds(t)) must_gather = true;
  }
  if (!must_gather) return;
  for (std::size_t i = 0; i < parameters_.spheres; ++i)
    gathered_[i] = contact_[i].active ? contact_[i].surface_point.triangle : contact::kNoTriangle;
  region_.gather({triangle.data(), count});
}

std::span<const ProbeSpring> SpringPatch::probes() RT_SAFE {
  const contact::SurfaceView& mesh = region_.surface().mesh;
  const double q = parameters_.coupling_stiffness_N_per_m;
  std::size_t count = 0;
  for (const SphereState& sphere_contact : contact_) {
    if (!sphere_contact.active) continue;
    ProbeSpring& probe = probe_[count];
    probe = {.weight = sphere_contact.surface_point.weight,
             .depth_m = sphere_contact.depth_m,
             .stiffness_N_per_m = q,
             .damping_Ns_per_m = parameters_.tissue.damping_time_s * q,
             .held = sphere_contact.held};
    bool inside = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangle[sphere_contact.surface_point.triangle][c];
      probe.node[c] = region_.slot_of(v);
      probe.push[c] = -mesh.vertex_normal[v];
      if (probe.node[c] == kNoSlot)
        inside = false;
      else if (region_.relaxes())  // the network is stepped at z, the tool meets u
        probe.depth_m -= probe.weight[c] * dot(probe.push[c], region_.flowed_m(probe.node[c]));
    }
    if (inside) ++count;
  }
  return {probe_.data(), count};
}

void SpringPatch::advance() RT_SAFE {
  if (organ() != nullptr) organ()->advance();
  if (broke_) return;
  follow_contacts();
  const SpringNetwork network = region_.network(probes());
  if (network.node.position_m.empty()) return;
  const StepRule rule = rule_of(parameters_);
  double energy_J = 0.0;
  // Depth and place are held over all substeps: the tool moves once a tick.
  for (std::size_t i = 0; i < parameters_.substeps; ++i) energy_J = stepper_.step(network, rule);
  if (region_.relaxes()) {
    region_.flow();
    energy_J = region_.stored_energy_J();
  }
  // Above the surface at rest, so that W is 0 without contact.
  network_energy_J_ = energy_J - region_.rest_energy_J();
  if (!std::isfinite(energy_J)) give_up();
}

void SpringPatch::give_up() RT_SAFE {
  broke_ = true;
  region_.rest();
  gathered_.fill(contact::kNoTriangle);
  network_energy_J_ = 0.0;
}

double SpringPatch::stored_energy_J() RT_SAFE {
  const SpringNetwork network = region_.network(probes());
  double energy_J = region_.stored_energy_J() - region_.rest_energy_J();
  for (const ProbeSpring& probe : network.probe) {
    const double f =
        probe_force_N(probe, indentation_m(probe, network.node.position_m, network.node.rest_m));
    energy_J += 0.5 * f * f / probe.stiffness_N_per_m;
  }
  return energy_J;
}

double SpringPatch::kinetic_energy_J() RT_SAFE {
  return model::springs::kinetic_energy_J(region_.network({}));
}

bool SpringPatch::shape(contact::PatchShape& out) RT_SAFE {
  out.node_count = 0;
  const auto show = [&out, this](std::uint32_t v) RT_SAFE {
    const Vec3 moved_m = region_.moved_m(v);
    if (dot(moved_m, moved_m) < kShownMove_m * kShownMove_m) return;
    out.vertex[out.node_count] = v;
    out.displacement_m[out.node_count++] = {static_cast<float>(moved_m.x),
                                            static_cast<float>(moved_m.y),
                                            static_cast<float>(moved_m.z)};
  };
  const std::span<const std::uint32_t> cut_edges = region_.cut_edges();
  const std::size_t newest = cut_edges.size() - std::min(cut_edges.size(), kShownCutEdges);
  for (const std::uint32_t v : cut_edges.subspan(newest)) show(v);
  for (const std::uint32_t v : region_.vertices())
    if (out.node_count < contact::kMaxShapeNodes && (newest > 0 || !region_.is_cut_edge(v)))
      show(v);
  const std::span<const std::uint32_t> cut = region_.cut_triangles();
  // The window goes round the list: a viewer that lost some frames learns of all cuts in the end.
  if (next_cut_ >= cut.size()) next_cut_ = 0;
  out.cut_total = static_cast<std::uint32_t>(cut.size());
  out.cut_first = next_cut_;
  out.cut_count = static_cast<std::uint32_t>(std::min(cut.size() - next_cut_, contact::kCutWindow));
  for (std::uint32_t i = 0; i < out.cut_count; ++i) out.cut_triangle[i] = cut[next_cut_ + i];
  next_cut_ += out.cut_count;
  return true;
}

}  // namespace tact::model::springs
