// SPDX-License-Identifier: Apache-2.0
#include "tools/sweep/reference_presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "model/io/json.h"
#include "model/mesh/turn.h"
#include "model/scene/tissue.h"

namespace tact::tools::sweep {
namespace {

using model::Error;
using model::Quat;
using model::Result;
using model::Tool;
using model::Vec3;
using nlohmann::json;

constexpr double kStep_m = 2e-5, kAbove_m = 5e-4;
constexpr double kFirst_m = 0.99e-3, kLast_m = 10.01e-3;  // of the depths that are evaluated

/// A straight way: from first contact on.
struct Way {
  Vec3 touch_m, inward;
  Quat orientation;

  Tool at(double depth_m) const {
    return {.position_m = touch_m + depth_m * inward, .orientation = orientation};
  }
};

double gap_m(const model::contact::ContactScene& contact, const Tool& tool) {
  double least_m = 1.0;
  for (const model::contact::ProbeSphere& s : contact.spheres)
    least_m = std::min(
        least_m, nearest_contact_point(contact.tree, contact.surface,
                                       tool.position_m + rotate(tool.orientation, s.offset_m), 1.0,
                                       model::contact::kNoTriangle)
                         .distance_m -
                     s.radius_m);
  return least_m;
}

/// From 30 mm outside to first contact.
Way way_to(const model::contact::ContactScene& contact, const Vec3& point_m, const Vec3& inward,
           double turned_deg) {
  constexpr double kFrom_m = -0.03, kMarch_m = 1.5e-3;
  constexpr int kHalvings = 40;
  const Vec3 along = normalized(inward);
  Way way{point_m, along,
          model::mesh::turn_between({0, 0, -1}, along) *
              model::quat_from_rotation_vector({0, 0, turned_deg * std::numbers::pi / 180.0})};
  double high_m = kFrom_m;
  while (high_m < -kFrom_m && gap_m(contact, way.at(high_m)) > 0.0) high_m += kMarch_m;
  double low_m = high_m - kMarch_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (gap_m(contact, way.at(middle_m)) > 0.0 ? low_m : high_m) = middle_m;
  }
  way.touch_m += low_m * along;
  return way;
}

/// A press of the scene, step by step, held against one of the reference.
Result<ReferencePress> check(const model::contact::ContactScene& scene, const Way& way,
                             const json& truth) {
  ReferencePress out;
  out.place = truth.at("place");
  model::contact::Contact contact(scene);
  double depth_m = -kAbove_m;
  Vec3 force_N;
  const auto render_force = [&](double at_m) {
    contact.detect_contact(way.at(at_m));
    force_N = contact.render_force(way.at(at_m), false).wrench.force_N;
  };
  for (std::size_t k = 0; k < truth.at("depth_m").size(); ++k) {
    const double want_m = truth.at("depth_m").at(k), want_N = truth.at("force_N").at(k);
    for (; depth_m < want_m - 0.5 * kStep_m; depth_m += kStep_m) render_force(depth_m);
    render_force(want_m);
    if (want_m < kFirst_m || want_m > kLast_m) continue;
    const double off = -dot(force_N, way.inward) / want_N - 1.0;
    if (std::abs(off) > std::abs(out.worst_ratio))
      out.worst_ratio = off, out.worst_depth_m = want_m;
    // The jaws of the reference have no names: as they fit.
    std::vector<double> want = truth.at("each_jaw_N").at(k), found;
    for (const model::contact::SphereContact& sphere_contact : contact.contacts())
      found.push_back(-dot(sphere_contact.force_N, way.inward));
    std::ranges::sort(want);
    std::ranges::sort(found);
    for (std::size_t i = 0; i < std::min(want.size(), found.size()); ++i)
      out.worst_jaw_ratio =
          std::max(out.worst_jaw_ratio, std::abs(found[i] - want[i]) / std::abs(want_N));
  }
  return out;
}

}  // namespace

Result<std::vector<ReferencePress>> press_reference(const model::scene::Scene& scene,
                                                    const std::string& path) {
  const auto document = model::io::read_json(path, "name a file of presses that were solved");
  if (!document) return document.error();
  model::scene::Scene smooth = scene;
  smooth.contact.friction_ratio = 0.0;
  smooth.relaxation.clear();
  const auto tissue = make_tissue(smooth);
  if (!tissue) return tissue.error();
  const model::contact::ContactScene& contact = (*tissue)->contact_scene();
  std::vector<ReferencePress> out;
  try {
    for (const json& truth : document->at("places")) {
      const bool is_of_vertex = truth.contains("vertex");
      const std::size_t v = is_of_vertex ? truth.at("vertex").get<std::size_t>() : 0;
      if (v >= smooth.organ_mesh.vertex_m.size())
        return Error{fmt::format("{}: vertex {} is none of the organ, which has 0 to {}", path, v,
                                 smooth.organ_mesh.vertex_m.size() - 1)};
      const Way way =
          way_to(contact, is_of_vertex ? smooth.organ_mesh.vertex_m[v] : smooth.hand_site_m,
                 is_of_vertex ? -smooth.organ_mesh.vertex_normal[v] : smooth.hand_inward,
                 truth.value("turned_deg", 0.0));
      auto press = check(contact, way, truth);
      if (!press) return Error{path + ": " + press.error().message};
      out.push_back(std::move(*press));
    }
  } catch (const json::exception& wrong) {
    return Error{
        fmt::format("{} is no file of solved presses: {}; it needs \"places\", each with "
                    "\"place\", \"depth_m\", \"force_N\" and \"each_jaw_N\"",
                    path, wrong.what())};
  }
  return out;
}

std::string text_of(const std::vector<ReferencePress>& presses) {
  std::string out = "force along the way, 1 to 10 mm, without friction\n";
  for (const ReferencePress& p : presses)
    out += fmt::format(
        "{:<14} {:+.1f} % at {:.1f} mm, one sphere {:.1f} % of the whole tool's force\n", p.place,
        100.0 * p.worst_ratio, 1e3 * p.worst_depth_m, 100.0 * p.worst_jaw_ratio);
  return out;
}

std::string json_of(const std::vector<ReferencePress>& presses) {
  json out = json::object();
  for (const ReferencePress& p : presses)
    out[p.place] = {{"worst_ratio", p.worst_ratio},
                    {"worst_depth_m", p.worst_depth_m},
                    {"worst_sphere_ratio", p.worst_jaw_ratio}};
  return model::io::text_of(out, 2);
}

}  // namespace tact::tools::sweep
