// SPDX-License-Identifier: Apache-2.0
#include "model/scene/press.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "model/contact/triangle_tree.h"
#include "model/mesh/turn.h"
#include "model/scene/scene_strokes.h"

namespace tact::model::scene {
namespace {

constexpr double kAbove_m = 0.003;    // where a way begins, as the references of the whole tool
constexpr double kBackOff_m = 0.001;  // further out, where a sphere is in the organ there

/// Where the tool is at a depth.
class Way {
 public:
  Way(const contact::ContactScene& contact, const Vec3& inward, const PressPoint& place)
      : point_m_(contact.surface.vertex_m[place.vertex]),
        along_(inward),
        reach_m_(reach_m(contact.spheres, inward)) {
    if (place.way == PressWay::kUpright) return;
    along_ = -contact.surface.vertex_normal[place.vertex];
    orientation_ = mesh::turn_between(inward, along_);
  }

  const Vec3& along() const { return along_; }
  Tool tool_at(double depth_m) const {
    return {.position_m = point_m_ - (reach_m_ - depth_m) * along_, .orientation = orientation_};
  }

 private:
  Vec3 point_m_, along_;
  Quat orientation_{};
  double reach_m_;
};

bool is_outside(const contact::ContactScene& contact, const Tool& tool) {
  return std::ranges::all_of(contact.spheres, [&](const contact::ProbeSphere& sphere) {
    const Vec3 centre_m = tool.position_m + rotate(tool.orientation, sphere.offset_m);
    // Beyond 1 m nothing is near.
    return contact::nearest_contact_point(contact.tree, contact.surface, centre_m, 1.0,
                                          contact::kNoTriangle)
               .distance_m >= sphere.radius_m;
  });
}

/// Half the extent of the tool across its path.
double breadth_m(const contact::ContactScene& contact, const Vec3& inward) {
  double most_m = 0.0;
  for (const contact::ProbeSphere& sphere : contact.spheres)
    most_m = std::max(most_m, norm(tangential(sphere.offset_m, inward)) + sphere.radius_m);
  return most_m;
}

/// The deepest depth, at most -kAbove_m, at which the whole tool is outside. Not farther than a
/// flank of 60 degrees keeps the tool away: beyond, the tool would meet another part of the organ.
std::optional<double> start_m(const contact::ContactScene& contact, const Vec3& inward,
                              const Way& way) {
  const double farthest_m = kAbove_m + 2.0 * breadth_m(contact, inward);
  for (double depth_m = -kAbove_m; depth_m >= -farthest_m; depth_m -= kBackOff_m)
    if (is_outside(contact, way.tool_at(depth_m))) return depth_m;
  return std::nullopt;
}

double median(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// Sums up the steps of one press.
class Record {
 public:
  Record(PressResult& out, double step_m) : out_(out), step_m_(step_m) {}

  PressStep add(double depth_m, const Vec3& along, const Vec3& force_N, double stored_J) {
    const double along_N = -dot(force_N, along);
    const double change_N = norm(force_N - force_before_N_);
    if (change_N > out_.change_N.value) out_.change_N = {change_N, depth_m};
    if (along_N < out_.least_N.value) out_.least_N = {along_N, depth_m};
    slopes_[2] = (along_N - along_before_N_) / step_m_;
    const double slope_N_per_m = median(slopes_[0], slopes_[1], slopes_[2]);
    if (slope_N_per_m > out_.slope_N_per_m.value) out_.slope_N_per_m = {slope_N_per_m, depth_m};
    slopes_[0] = slopes_[1], slopes_[1] = slopes_[2];
    // A = int F dd, by trapezoids
    work_J_ += 0.5 * (along_N + along_before_N_) * step_m_;
    most_N_ = std::max(most_N_, norm(force_N));
    add_energy(depth_m, stored_J);
    force_before_N_ = force_N, along_before_N_ = along_N;
    out_.force_N = along_N;
    out_.deepest_m = depth_m;
    return {depth_m, force_N, along_N, stored_J, work_J_};
  }
  bool has_touched() const { return most_N_ > 0.0; }

 private:
  void add_energy(double depth_m, double stored_J) {
    const double excess_J = std::abs(stored_J - work_J_) - most_N_ * step_m_;
    if (!(excess_J > 0.0)) return;
    const double ratio =
        std::copysign(excess_J / std::max(work_J_, most_N_ * step_m_), stored_J - work_J_);
    if (std::abs(ratio) > std::abs(out_.energy_ratio.value)) out_.energy_ratio = {ratio, depth_m};
  }

  PressResult& out_;
  double step_m_;
  Vec3 force_before_N_{};
  double along_before_N_ = 0.0, work_J_ = 0.0, most_N_ = 0.0;
  std::array<double, 3> slopes_{};  // of the last steps
};

double stored_J(const contact::Contact& contact) {
  double sum_J = 0.0;
  for (const contact::SphereContact& sphere_contact : contact.contacts())
    sum_J += sphere_contact.energy_J;
  return sum_J;
}

}  // namespace

PressResult press_once(const contact::ContactScene& contact, const Vec3& inward,
                       const PressPoint& place, const PressSettings& settings,
                       const std::function<void(const PressStep&)>& on_step) {
  PressResult out;
  out.place = place;
  const Way way(contact, inward, place);
  const auto from_m = start_m(contact, inward, way);
  if (!from_m) return out;
  contact::Contact touching(contact);
  Record record(out, settings.step_m);
  const auto steps =
      static_cast<std::size_t>(std::ceil((settings.depth_m - *from_m) / settings.step_m));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double depth_m = *from_m + static_cast<double>(i) * settings.step_m;
    const Tool tool = way.tool_at(depth_m);
    touching.detect_contact(tool);
    const contact::ContactResponse rendered = touching.render_force(tool, false);
    out.is_not_rendered = rendered.is_inside || rendered.is_lost;
    out.is_unsettled = out.is_unsettled || rendered.is_unsettled;
    // Deeper than the law reaches nothing is promised of its slope.
    if (rendered.is_saturated) break;
    const PressStep step =
        record.add(depth_m, way.along(), rendered.wrench.force_N, stored_J(touching));
    if (on_step) on_step(step);
    if (out.is_not_rendered) break;
  }
  const bool touched = record.has_touched() || out.is_not_rendered;
  out.state = touched ? PressState::kPressed : PressState::kMissed;
  return out;
}

Result<std::unique_ptr<Presser>> Presser::make(const Scene& scene, const PressSettings& settings,
                                               const Tissue* tissue) {
  std::unique_ptr<Presser> presser(new Presser(scene, settings));
  if (tissue == nullptr) {
    auto own = make_tissue(scene);
    if (!own) return own.error();
    presser->own_tissue_ = std::move(*own);
  }
  presser->tissue_ = tissue != nullptr ? tissue : presser->own_tissue_.get();
  const TissueLaw& law = presser->tissue_->law();
  PressSettings& own = presser->settings_;
  if (!(own.depth_m > 0.0)) own.depth_m = law.range().press_m;
  own.checks_energy = own.checks_energy && law.curve() != nullptr;
  if (!own.checks_energy) return presser;
  presser->elastic_scene_ = scene;
  presser->elastic_scene_.relaxation.clear();
  presser->elastic_scene_.contact.friction_ratio = 0.0;
  auto elastic = make_tissue(presser->elastic_scene_);
  if (!elastic) return elastic.error();
  presser->elastic_tissue_ = std::move(*elastic);
  return presser;
}

PressResult Presser::press(const PressPoint& place) {
  PressResult out = press_once(tissue_->contact_scene(), inward_, place, settings_);
  out.energy_ratio = {};
  if (settings_.checks_energy && out.state == PressState::kPressed)
    out.energy_ratio =
        press_once(elastic_tissue_->contact_scene(), inward_, place, settings_).energy_ratio;
  return out;
}

PressFlaws flaws_of(const PressResult& r, const PressSettings& s) {
  if (r.state != PressState::kPressed) return {};
  return {.draws_in = r.least_N.value < -kDrawTolerance_N,
          .changes_too_fast = r.is_unsettled || r.change_N.value > s.limit_N_per_m * s.step_m,
          .is_too_stiff = r.slope_N_per_m.value > s.limit_N_per_m,
          .is_not_rendered = r.is_not_rendered,
          .energy_differs = std::abs(r.energy_ratio.value) > kEnergyTolerance_ratio};
}

std::string name_of(const PressPoint& place) {
  return fmt::format("vertex {}, {}", place.vertex,
                     place.way == PressWay::kSquare ? "square" : "upright");
}

std::string describe_flaws(const PressResult& r, const PressSettings& s) {
  const PressFlaws flaws = flaws_of(r, s);
  std::string out;
  const auto say = [&out](bool holds, const std::string& what) {
    if (holds) out += (out.empty() ? "" : "; ") + what;
  };
  say(flaws.is_not_rendered,
      fmt::format("a sphere comes into the organ without force at {:.2f} mm", 1e3 * r.deepest_m));
  say(flaws.draws_in, fmt::format("the force draws the tool in by {:.3g} N at {:.2f} mm",
                                  -r.least_N.value, 1e3 * r.least_N.depth_m));
  say(r.is_unsettled, "the force would jump and is slowed down");
  say(r.change_N.value > s.limit_N_per_m * s.step_m,
      fmt::format("the force changes by {:.3g} N in {:g} mm at {:.2f} mm (allowed: "
                  "{:.3g} N)",
                  r.change_N.value, 1e3 * s.step_m, 1e3 * r.change_N.depth_m,
                  s.limit_N_per_m * s.step_m));
  say(flaws.is_too_stiff,
      fmt::format("the slope is {:.4g} N/m at {:.2f} mm (allowed: {:.4g} N/m)",
                  r.slope_N_per_m.value, 1e3 * r.slope_N_per_m.depth_m, s.limit_N_per_m));
  say(flaws.energy_differs, fmt::format("the stored energy differs from the work by {:+.1f} % at "
                                        "{:.2f} mm",
                                        1e2 * r.energy_ratio.value, 1e3 * r.energy_ratio.depth_m));
  return out;
}

double severity(const PressResult& r, const PressSettings& s) {
  return std::max({r.is_not_rendered ? 1e6 : 0.0, -r.least_N.value / kDrawTolerance_N,
                   r.change_N.value / (s.limit_N_per_m * s.step_m),
                   r.slope_N_per_m.value / s.limit_N_per_m,
                   std::abs(r.energy_ratio.value) / kEnergyTolerance_ratio});
}

}  // namespace tact::model::scene
