#include "model/elastic_field.h"

#include <algorithm>
#include <cmath>

namespace tact::model {
namespace {

constexpr std::size_t kMaxProfile = 64;

// Of two parts of one force: a limit reached by either is told.
LawStatus worse(LawStatus a, LawStatus b) RT_SAFE {
  return b >= LawStatus::kSaturated && b > a ? b : a;
}

}  // namespace

ElasticField::Blend ElasticField::blend_at(const Place& place) const RT_SAFE {
  if (parts_.curves.size() < 2) return {};
  const TriangleCorners& corner = parts_.surface.triangle[place.triangle];
  double kappa = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    kappa += place.weight[i] * static_cast<double>(parts_.coordinate[corner[i]]);
  const std::size_t last = parts_.curves.size() - 2;
  const std::size_t low = kappa > 0.0 ? std::min(static_cast<std::size_t>(kappa), last) : 0;
  return {.low = low, .fraction = kappa - static_cast<double>(low)};
}

// energy_step_J = U_(k+1) - U_k.
LawResponse ElasticField::respond_at(const Blend& blend, double depth_m,
                                     double& energy_step_J) const RT_SAFE {
  const LawResponse soft = parts_.curves[blend.low]->respond(depth_m);
  energy_step_J = 0.0;
  if (parts_.curves.size() < 2) return soft;
  const LawResponse stiff = parts_.curves[blend.low + 1]->respond(depth_m);
  energy_step_J = stiff.energy_J - soft.energy_J;
  const double f = blend.fraction;
  return {.force_N = soft.force_N + f * (stiff.force_N - soft.force_N),
          .stiffness_N_per_m =
              soft.stiffness_N_per_m + f * (stiff.stiffness_N_per_m - soft.stiffness_N_per_m),
          .energy_J = soft.energy_J + f * energy_step_J,
          .status = worse(soft.status, stiff.status)};
}

// grad kappa of a linear function on a triangle: sum of kappa_i (n x opposite edge i) / (2 area).
Vec3 ElasticField::coordinate_slope(std::uint32_t triangle) const RT_SAFE {
  const SurfaceView& s = parts_.surface;
  const TriangleCorners& corner = s.triangle[triangle];
  const Vec3 &a = s.vertex_m[corner[0]], &b = s.vertex_m[corner[1]], &c = s.vertex_m[corner[2]];
  const Vec3 twice_area = cross(b - a, c - a);
  const auto kappa = [&](std::size_t i)
                         RT_SAFE { return static_cast<double>(parts_.coordinate[corner[i]]); };
  const Vec3 sum = kappa(0) * (c - b) + kappa(1) * (a - c) + kappa(2) * (b - a);
  return cross(twice_area, sum) / dot(twice_area, twice_area);
}

SiteResponse ElasticField::respond(const Indentation& in) RT_SAFE {
  if (!std::isfinite(in.depth_m)) return {.law = {.status = LawStatus::kInvalid}};
  const Blend blend = blend_at(in.place);
  const Relaxation& relaxation = parts_.relaxation;
  next_[in.sphere] = relaxation.after(now_[in.sphere], in.depth_m, in.held);
  LawResponse sum{};
  double step_J = 0.0;  // U_(k+1) - U_k of the whole
  for (std::size_t i = 0; i <= relaxation.terms(); ++i) {
    const double depth_m = i == 0 ? in.depth_m : next_[in.sphere].stretch_m[i - 1];
    double step_i_J = 0.0;
    const LawResponse part = respond_at(blend, depth_m, step_i_J);
    const double g = relaxation.share(i);
    sum.force_N += g * part.force_N;
    sum.stiffness_N_per_m += g * part.stiffness_N_per_m;
    sum.energy_J += g * part.energy_J;
    step_J += g * step_i_J;
    sum.status = i == 0 ? part.status : worse(sum.status, part.status);
  }
  if (parts_.curves.size() < 2) return {.law = sum};
  return {.law = sum, .slope_N = step_J * coordinate_slope(in.place.triangle)};
}

std::size_t ElasticField::profile(const Indentation& in, std::span<double> ring_m) const RT_SAFE {
  const Blend blend = blend_at(in.place);
  const std::size_t count = parts_.curves[blend.low]->profile(in.depth_m, ring_m);
  if (parts_.curves.size() < 2) return count;
  std::array<double, kMaxProfile> stiff_m{};
  parts_.curves[blend.low + 1]->profile(in.depth_m, stiff_m);
  for (std::size_t j = 0; j < std::min({count, ring_m.size(), kMaxProfile}); ++j)
    ring_m[j] += blend.fraction * (stiff_m[j] - ring_m[j]);
  return count;
}

}  // namespace tact::model
