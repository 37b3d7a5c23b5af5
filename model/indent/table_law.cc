// SPDX-License-Identifier: Apache-2.0
#include "model/indent/table_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "model/law/ring_taper.h"

namespace tact::model::indent {
namespace {

using Rows = std::span<const TableRow>;
using Weights = std::array<double, TableLaw::kMaxKnots>;

constexpr std::size_t kMinRows = 5, kMinKnots = 4, kRowsAKnot = 3;
constexpr double kFloor_ratio = 0.003;   // of the peak: lighter forces are no shares of themselves
constexpr double kSoftest_ratio = 1e-3;  // of the mean stiffness, so that the force always rises
constexpr int kSweeps = 20'000;          // 14 unknowns: some milliseconds
constexpr double kDeepest_m = 0.2;
// Chosen. As deep as the end of the loading; a press that is let go; a step back of the drive.
constexpr double kAtEnd_ratio = 0.998, kStepBack_ratio = 0.01, kFall_ratio = 0.05;
constexpr double kSigmas = 6.0;  // of the noise: one row in a thousand million

Error blame(const TableRow& row, const std::string& what) {
  return Error{fmt::format(":{}: {}", row.line, what)};
}

/// Standard deviation of the noise, by the median of the second differences, which a smooth curve
/// hardly has.
double noise_N(Rows rows) {
  std::vector<double> bend_N;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i)
    bend_N.push_back(std::abs(rows[i - 1].force_N - 2.0 * rows[i].force_N + rows[i + 1].force_N));
  const auto middle = bend_N.begin() + static_cast<std::ptrdiff_t>(bend_N.size() / 2);
  std::nth_element(bend_N.begin(), middle, bend_N.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

double peak_N(Rows rows) { return std::ranges::max(rows, {}, &TableRow::force_N).force_N; }

/// Rows of the loading: up to the first that is as deep as the deepest.
Rows loading_of(Rows rows) {
  const double end_m = kAtEnd_ratio * std::ranges::max(rows, {}, &TableRow::depth_m).depth_m;
  const auto last =
      std::ranges::find_if(rows, [end_m](const TableRow& row) { return row.depth_m >= end_m; });
  return rows.first(static_cast<std::size_t>(last - rows.begin()) + 1);
}

/// By trapezoids, J.
double work_J(Rows rows) {
  double sum_J = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    sum_J +=
        0.5 * (rows[i].force_N + rows[i - 1].force_N) * (rows[i].depth_m - rows[i - 1].depth_m);
  return sum_J;
}

std::optional<Error> check_numbers(Rows rows) {
  if (rows.size() < kMinRows)
    return Error{fmt::format(": {} rows; a curve needs {} at least", rows.size(), kMinRows)};
  for (const TableRow& row : rows)
    if (!(row.depth_m >= 0.0 && row.depth_m <= kDeepest_m))
      return blame(row, fmt::format("the depth is {:g} m; it counts from the contact, 0 to {:g} m; "
                                    "name its column depth_mm if it is in mm",
                                    row.depth_m, kDeepest_m));
  if (peak_N(rows) > 0.0) return std::nullopt;
  return Error{": no force is above 0; a press counts positive"};
}

/// What no passive body does while it is loaded.
std::optional<Error> check_loading(Rows rows) {
  if (rows.size() < kMinRows)
    return blame(rows.back(),
                 "the deepest row comes too early; sort the rows as they were pressed");
  const double step_back_m = kStepBack_ratio * rows.back().depth_m;
  const double noise = kSigmas * noise_N(rows), floor_N = kFloor_ratio * peak_N(rows);
  double most_m = 0.0, most_N = 0.0;
  for (const TableRow& row : rows) {
    if (row.depth_m < most_m - step_back_m)
      return blame(row,
                   fmt::format("the depth falls from {:g} to {:g} m and rises again later; keep "
                               "one press alone",
                               most_m, row.depth_m));
    if (row.force_N < -noise - floor_N)
      return blame(row,
                   fmt::format("a force of {:g} N draws the tool in, which no passive tissue "
                               "does; take the offset of the sensor away, or leave the row out",
                               row.force_N));
    if (row.force_N < (1.0 - kFall_ratio) * most_N - noise - floor_N)
      return blame(row, fmt::format("the force falls from {:g} to {:g} N while the depth grows; "
                                    "tissue that cracks or slips gives energy back there; end the "
                                    "curve before it",
                                    most_N, row.force_N));
    most_m = std::max(most_m, row.depth_m), most_N = std::max(most_N, row.force_N);
  }
  return std::nullopt;
}

/// Is there more than the loading's last rows? Its loss, or why it is refused.
Result<double> check_unloading(Rows rows, Rows loading, bool is_left_out) {
  const Rows after = rows.subspan(loading.size());
  const double end_m = loading.back().depth_m;
  const bool falls = std::ranges::any_of(after, [end_m](const TableRow& row) {
    return row.depth_m < (1.0 - kStepBack_ratio) * end_m;
  });
  if (!falls && after.size() <= loading.size() / 20) return 0.0;
  const double taken_J = work_J(loading),
               returned_J = falls ? -work_J(rows.subspan(loading.size() - 1)) : 0.0;
  const double lost_ratio = 1.0 - returned_J / taken_J;
  if (returned_J > taken_J)
    return blame(after.front(),
                 fmt::format("the unloading from here on gives back {:.3g} mJ, the "
                             "loading took {:.3g} mJ; no passive tissue does that; is "
                             "the order of the rows turned round?",
                             1e3 * returned_J, 1e3 * taken_J));
  if (is_left_out) return lost_ratio;
  return blame(
      after.front(),
      fmt::format("from here on the press is {}, which one force a depth cannot follow "
                  "({:.0f} % of the work is lost); write unloading = \"leave_out\" for the "
                  "loading alone, and say the loss as [[relaxation]] (tact-lab fit)",
                  falls ? "unloaded" : "held", 100.0 * lost_ratio));
}

/// TB-1: what each k_j adds to F(d), m.
Weights weights_of(const auto& knots, double depth_m) {
  Weights w{};
  for (std::size_t j = 0; j + 1 < knots.size() && depth_m > knots[j].depth_m; ++j) {
    const double cell_m = knots[j + 1].depth_m - knots[j].depth_m;
    const double inside_m = std::min(depth_m - knots[j].depth_m, cell_m);
    const double high_m = 0.5 * inside_m * inside_m / cell_m;
    w[j] += inside_m - high_m, w[j + 1] += high_m;
  }
  return w;
}

}  // namespace

// Twice: weighed by the forces as measured, then by those of that fit. Noise that makes a force
// small would give it weight.
void TableLaw::fit(Rows loading, double force_ratio) {
  count_ = std::clamp(loading.size() / kRowsAKnot, kMinKnots, kMaxKnots);
  for (std::size_t j = 0; j < count_; ++j)
    knot_[j].depth_m = loading.back().depth_m *
                       std::pow(static_cast<double>(j) / static_cast<double>(count_ - 1), 2.0);
  const double floor_N = kFloor_ratio * peak_N(loading);
  std::vector<double> scale_N;
  for (const TableRow& row : loading) scale_N.push_back(std::max(row.force_N, floor_N));
  set_stiffness(loading, scale_N, 1.0);
  for (std::size_t i = 0; i < loading.size(); ++i)
    scale_N[i] = std::max(respond(loading[i].depth_m).force_N, floor_N);
  set_stiffness(loading, scale_N, force_ratio);
}

// TB-2 by projected Gauss-Seidel: each k_j in turn goes to its own best, not below the softest.
void TableLaw::set_stiffness(Rows loading, std::span<const double> scale_N, double force_ratio) {
  std::array<Weights, kMaxKnots> matrix{};
  Weights right{}, k{};
  for (std::size_t i = 0; i < loading.size(); ++i) {
    Weights w = weights_of(std::span(knot_).first(count_), loading[i].depth_m);
    for (double& weight : w) weight /= scale_N[i];
    for (std::size_t a = 0; a < count_; ++a) {
      right[a] += w[a] * loading[i].force_N / scale_N[i];
      for (std::size_t b = 0; b < count_; ++b) matrix[a][b] += w[a] * w[b];
    }
  }
  const double mean_N_per_m = peak_N(loading) / end_m();
  k.fill(mean_N_per_m);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t j = 0; j < count_; ++j) {
      if (!(matrix[j][j] > 0.0)) continue;  // no row there
      const double slope = std::inner_product(k.begin(), k.end(), matrix[j].begin(), -right[j]);
      k[j] = std::max(k[j] - slope / matrix[j][j], kSoftest_ratio * mean_N_per_m);
    }
  knot_[0].stiffness_N_per_m = force_ratio * k[0];
  for (std::size_t j = 1; j < count_; ++j) {
    const Knot& before = knot_[j - 1];
    knot_[j].stiffness_N_per_m = force_ratio * k[j];
    const law::LawResponse end = between(before, knot_[j], knot_[j].depth_m);
    knot_[j].force_N = end.force_N, knot_[j].energy_J = end.energy_J;
  }
}

// TB-1: K is linear between two knots, F and U its integrals
law::LawResponse TableLaw::between(const Knot& low, const Knot& high, double depth_m) RT_SAFE {
  const double x_m = depth_m - low.depth_m, k_N_per_m = low.stiffness_N_per_m;
  const double bend_N_per_m2 = (high.stiffness_N_per_m - k_N_per_m) / (high.depth_m - low.depth_m);
  return {.force_N = low.force_N + x_m * (k_N_per_m + x_m * bend_N_per_m2 / 2.0),
          .stiffness_N_per_m = k_N_per_m + x_m * bend_N_per_m2,
          .energy_J = low.energy_J +
                      x_m * (low.force_N + x_m * (k_N_per_m / 2.0 + x_m * bend_N_per_m2 / 6.0))};
}

law::LawResponse TableLaw::respond(double depth_m) const RT_SAFE {
  return law::press_response(depth_m, end_m(), [this](double inside_m) RT_SAFE {
    std::size_t j = 0;
    while (j + 2 < count_ && knot_[j + 1].depth_m < inside_m) ++j;
    return between(knot_[j], knot_[j + 1], inside_m);
  });
}

std::size_t TableLaw::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  return law::lone_profile(depth_m, ring_m);
}

void visit(ParameterVisitor& v, TableParameters& p) {
  v.file("data", "CSV of a press: depth_mm or depth_m, force_N or force_mN", p.data,
         Need::kOptional);
  v.number("force_ratio", {0.001, 1000.0}, "times the measured force", p.force_ratio,
           Need::kOptional);
  constexpr std::array kUnloading{Choice{"refuse", "a file that has it"},
                                  Choice{"leave_out", "the loading alone gives force"}};
  v.choice("unloading", kUnloading, "rows after the deepest one", p.leaves_unloading,
           Need::kOptional);
}

Result<TableLaw> make_table_law(Rows rows, const TableParameters& p) {
  if (auto wrong = check_meaning("table", p)) return *wrong;
  if (auto wrong = check_numbers(rows)) return *wrong;
  const Rows loading = loading_of(rows);
  if (auto wrong = check_loading(loading)) return *wrong;
  const auto lost = check_unloading(rows, loading, p.leaves_unloading);
  if (!lost) return lost.error();
  TableLaw law;
  law.lost_ratio_ = *lost;
  law.fit(loading, p.force_ratio);
  return law;
}

}  // namespace tact::model::indent
