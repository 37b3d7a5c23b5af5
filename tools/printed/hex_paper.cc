// SPDX-License-Identifier: Apache-2.0
#include "tools/printed/hex_paper.h"

#include <cmath>

#include "model/ranges.h"

namespace tact::tools::printed {
namespace {

using model::Error;
using model::is_positive;
using model::indent::kMaxHexRings;
using model::law::CurvePoint;
using model::law::HermiteTable;

constexpr int kMaxIterations = 60;
constexpr std::size_t kKnots = 129;

double alpha_of(std::size_t ring) RT_SAFE { return 2.0 * static_cast<double>(ring) - 1.0; }

/// How much body spring hangs on rings 0 .. ring - 1: what a unit of l_ring stretches, HX-12.
double weight_inside(HexWeight weight, std::size_t ring) RT_SAFE {
  const double i = static_cast<double>(ring);
  return weight == HexWeight::kRing ? i : 1.0 + 3.0 * i * (i - 1.0);
}

/// The shape has one unknown. Instead of c it is solved in t = l_1/r, where c = 1 - 1/s,
/// s = sqrt(1 + t^2): d(t) is concave and almost straight, without a singular end.
struct Drop {
  double drop_m, slope_m;  // l_i and dl_i/dt
};

Drop drop(double pitch_m, std::size_t ring, double t) RT_SAFE {
  if (ring == 1) return {pitch_m * t, pitch_m};
  const double s = std::sqrt(1.0 + t * t), c = t * t / (s * (s + 1.0)), a = alpha_of(ring);
  const double top = std::sqrt(2.0 * a - c), root = std::sqrt(s * (s + 1.0));
  // HX-9, with sqrt(c) = t/root;  dl/dt from dl/dc = r a^2/(sqrt(c (2a - c)) (a - c)^2)
  return {pitch_m * t * top / (root * (a - c)),
          pitch_m * a * a * root / (s * s * s * top * (a - c) * (a - c))};
}

struct Curve {
  double depth_m, depth_slope_m;  // sum of l_i and its slope in t
  double pull, pull_slope;        // sum of weight_inside l_i and its slope in t
};

Curve curve_at(double pitch_m, std::size_t rings, HexWeight weight, double t) RT_SAFE {
  Curve out{};
  for (std::size_t i = rings; i >= 1; --i) {
    const Drop l = drop(pitch_m, i, t);
    const double inside = weight_inside(weight, i);
    out.depth_m += l.drop_m;
    out.depth_slope_m += l.slope_m;
    out.pull += inside * l.drop_m;
    out.pull_slope += inside * l.slope_m;
  }
  return out;
}

/// HX-11  the t with d(t) = d. l_1 <= d gives t <= d/r; concavity gives t >= d/d'(0), and makes
/// Newton climb from there without overshoot.
double first_slope_at(double pitch_m, std::size_t rings, double depth_m) RT_SAFE {
  double low = depth_m / curve_at(pitch_m, rings, HexWeight::kRing, 0.0).depth_slope_m;
  const double high = depth_m / pitch_m;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Curve at = curve_at(pitch_m, rings, HexWeight::kRing, low);
    double next = low + (depth_m - at.depth_m) / at.depth_slope_m;
    if (next > high) next = high;
    const bool done = std::abs(next - low) <= 4e-16 * next;
    low = next;
    if (done) break;
  }
  return low;
}

PaperShape shape_at(double pitch_m, std::size_t rings, double t) RT_SAFE {
  const double s = std::sqrt(1.0 + t * t), c = t * t / (s * (s + 1.0));
  PaperShape out{.rings = rings, .first_strain = t * t / (s + 1.0)};
  double z = 0.0;
  for (std::size_t i = rings; i >= 1; --i) {
    // HX-8  eps_i = c/(alpha_i - c);  alpha_1 - c = 1/s
    out.strain[i - 1] = i == 1 ? out.first_strain : c / (alpha_of(i) - c);
    out.drop_m[i - 1] = drop(pitch_m, i, t).drop_m;
    out.ring_m[i - 1] = z += out.drop_m[i - 1];  // HX-6
  }
  out.boundary_slope = out.drop_m[rings - 1] / pitch_m;
  return out;
}

bool has_shape(double pitch_m, std::size_t rings, double input) RT_SAFE {
  return is_positive(pitch_m) && rings >= 1 && rings <= kMaxPaperRings && std::isfinite(input) &&
         input >= 0.0;
}

}  // namespace

PaperShape paper_shape_at_strain(double pitch_m, std::size_t rings, double first_strain) RT_SAFE {
  if (!has_shape(pitch_m, rings, first_strain)) return {};
  // t = l_1/r = sqrt(eps_1 (2 + eps_1))
  return shape_at(pitch_m, rings, std::sqrt(first_strain * (2.0 + first_strain)));
}

PaperShape paper_shape_at_depth(double pitch_m, std::size_t rings, double depth_m) RT_SAFE {
  if (!has_shape(pitch_m, rings, depth_m)) return {};
  PaperShape out = shape_at(pitch_m, rings, first_slope_at(pitch_m, rings, depth_m));
  out.ring_m[0] = depth_m;
  return out;
}

double paper_force_N(const PaperShape& shape, double stiffness_N_per_m, HexWeight weight) RT_SAFE {
  // HX-12  F = K_N sum W_j Z_j
  double sum_m = shape.ring_m[0];
  for (std::size_t j = 1; j <= shape.rings; ++j)
    sum_m += (weight == HexWeight::kNode ? 6.0 * static_cast<double>(j) : 1.0) * shape.ring_m[j];
  return stiffness_N_per_m * sum_m;
}

PaperRings paper_rings(double first_strain, double boundary_slope) RT_SAFE {
  if (!is_positive(first_strain) || !is_positive(boundary_slope))
    return {.status = LawStatus::kInvalid};
  const double b2 = boundary_slope * boundary_slope, c = first_strain / (1.0 + first_strain);
  // HX-13  eps_m = sqrt(1 + b^2) - 1 = b^2/(sqrt(1 + b^2) + 1)
  const double strain = b2 / (std::sqrt(1.0 + b2) + 1.0);
  const double exact = 0.5 * (1.0 + c * (1.0 + strain) / strain);
  if (!(exact < 1e9)) return {.exact = exact, .status = LawStatus::kInvalid};
  if (exact < 1.0) return {.exact = exact, .rings = 1, .status = LawStatus::kSaturated};
  return {.exact = exact, .rings = static_cast<std::size_t>(std::ceil(exact))};
}

Result<HexPaper> make_hex_paper(const HexPaperParameters& p) {
  if (!is_positive(p.ring_pitch_m) || !is_positive(p.body_stiffness_N_per_m) ||
      !is_positive(p.working_depth_m) || p.rings < 1 || p.rings > kMaxHexRings)
    return Error{"hexagonal sheet as printed: every number must be above 0, rings at most 31"};
  return HexPaper(p);
}

HexPaper::HexPaper(const HexPaperParameters& parameters)
    : p_(parameters),
      table_(p_.working_depth_m / static_cast<double>(kKnots - 1), kKnots, [this](double depth_m) {
        const double t = first_slope_at(p_.ring_pitch_m, p_.rings, depth_m);
        const Curve at = curve_at(p_.ring_pitch_m, p_.rings, p_.weight, t);
        // dF/dd = K_N (sum of weight_inside dl_i/dt)/(sum of dl_i/dt)
        return CurvePoint{.value = p_.body_stiffness_N_per_m * at.pull,
                          .slope = p_.body_stiffness_N_per_m * at.pull_slope / at.depth_slope_m};
      }) {}

LawResponse HexPaper::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = LawStatus::kInvalid};
  const double size_m = std::abs(depth_m), limit_m = p_.working_depth_m;
  const double sign = depth_m < 0.0 ? -1.0 : 1.0;
  if (size_m <= limit_m) {
    const CurvePoint at = table_.at(size_m);
    return {sign * at.value, at.slope, at.integral, LawStatus::kOk};
  }
  const CurvePoint end = table_.at(limit_m);
  return {sign * end.value, 0.0, end.integral + end.value * (size_m - limit_m),
          LawStatus::kSaturated};
}

std::size_t HexPaper::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const double size_m = std::fmin(std::abs(depth_m), p_.working_depth_m);
  const PaperShape shape =
      paper_shape_at_depth(p_.ring_pitch_m, p_.rings, std::isfinite(depth_m) ? size_m : 0.0);
  const std::size_t count = p_.rings + 1 < ring_m.size() ? p_.rings + 1 : ring_m.size();
  for (std::size_t j = 0; j < count; ++j)
    ring_m[j] = depth_m < 0.0 ? -shape.ring_m[j] : shape.ring_m[j];
  return count;
}

}  // namespace tact::tools::printed
