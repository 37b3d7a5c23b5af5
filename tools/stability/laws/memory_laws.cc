// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/laws/memory_laws.h"

#include <array>
#include <vector>

#include "model/law/relaxation.h"
#include "model/mesh/mesh.h"
#include "model/springs/spring_patch.h"
#include "model/tissue/elastic_field.h"

namespace tact::tools::stability {
namespace {

constexpr double kTick_s = 0.001;
// Chosen: half of the force fades, within the run of a cell (memory_laws.h).
constexpr std::array<model::law::PronyTerm, 2> kTerms{
    {{.share = 0.3, .time_s = 0.03}, {.share = 0.2, .time_s = 0.1}}};

const model::mesh::SurfaceMesh& plate() {
  // One for all: every run of a search makes a law of its own, and they only read it.
  static const model::mesh::SurfaceMesh mesh = [] {
    constexpr std::uint32_t kCells = 20;
    constexpr double kWidth_m = 0.1;
    std::vector<model::Vec3> vertex_m;
    std::vector<model::contact::TriangleCorners> triangle;
    for (std::uint32_t y = 0; y <= kCells; ++y)
      for (std::uint32_t x = 0; x <= kCells; ++x)
        vertex_m.push_back(
            {kWidth_m * (x / double{kCells} - 0.5), kWidth_m * (y / double{kCells} - 0.5), 0.0});
    const auto at = [](std::uint32_t x, std::uint32_t y) { return y * (kCells + 1) + x; };
    for (std::uint32_t y = 0; y < kCells; ++y)
      for (std::uint32_t x = 0; x < kCells; ++x) {
        triangle.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
        triangle.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
      }
    return *model::mesh::make_surface_mesh(vertex_m, triangle);
  }();
  return mesh;
}

/// An elastic field of one law that it owns.
class RelaxingLaw final : public model::contact::ContactLaw {
 public:
  RelaxingLaw(std::shared_ptr<const model::law::Law> law, const model::law::Relaxation& relaxation)
      // Before curve_ and field_, which point into it; so the object neither copies nor moves.
      : law_(std::move(law)),
        curve_{law_.get()},
        field_({.curves = curve_,
                .coordinate = {},
                .pull_coordinate = {},
                .surface = plate().view(),
                .relaxation = relaxation}) {}
  RelaxingLaw(const RelaxingLaw&) = delete;
  RelaxingLaw& operator=(const RelaxingLaw&) = delete;

  model::contact::ContactLawResponse respond(
      const model::contact::Indentation& in) RT_SAFE override {
    return field_.respond(in);
  }
  void leave(std::size_t sphere) RT_SAFE override { field_.leave(sphere); }
  void advance() RT_SAFE override { field_.advance(); }
  std::size_t profile(const model::contact::Indentation& in,
                      std::span<double> ring_m) const RT_SAFE override {
    return field_.profile(in, ring_m);
  }
  double ring_pitch_m() const RT_SAFE override { return field_.ring_pitch_m(); }

 private:
  std::shared_ptr<const model::law::Law> law_;
  std::array<const model::law::Law*, 1> curve_;
  model::tissue::ElasticField field_;
};

}  // namespace

ContactLawMaker patch_maker(bool relaxes) {
  model::springs::SpringPatchParameters p{.tissue = {.surface_stiffness_N_per_m = 50.0,
                                                     .body_stiffness_N_per_m = 5.0,
                                                     .damping_time_s = 0.0008,
                                                     .body_damping_time_s = 0.03,
                                                     .pretension_ratio = 0.05},
                                          .coupling_stiffness_N_per_m = 300.0,
                                          // Chosen: the step check accepts it at 1 ms (MA-20).
                                          .node_mass_kg = 0.002,
                                          .working_depth_m = kPatchRange_m,
                                          .tick_s = kTick_s,
                                          .nodes = 120};
  if (relaxes) p.relaxation = *model::law::make_relaxation(kTerms, kTick_s);
  return [p]() -> std::unique_ptr<model::contact::ContactLaw> {
    return std::move(*model::springs::make_spring_patch(plate().view(), p));
  };
}

ContactLawMaker relaxing_maker(const std::shared_ptr<const model::law::Law>& law) {
  const model::law::Relaxation relaxation = *model::law::make_relaxation(kTerms, kTick_s);
  return [law, relaxation] { return std::make_unique<RelaxingLaw>(law, relaxation); };
}

}  // namespace tact::tools::stability
