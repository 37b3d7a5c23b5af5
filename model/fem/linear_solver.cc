// SPDX-License-Identifier: Apache-2.0
#include "model/fem/linear_solver.h"

#include <dmumps_c.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tact::model::fem {
namespace {

// Of the manual of MUMPS 5.5, whose arrays begin at 1.
enum class Job { kBegin = -1, kEnd = -2, kAnalyse = 1, kFactor = 2, kSolve = 3 };
constexpr int kThisProcess = -987654;  // comm_fortran of the version without MPI
constexpr int kNegativePivots = 12, kPrint = 1, kOrdering = 7, kMoreMemory_percent = 14,
              kSparseLoads = 20, kLoadsAtOnce = 27;
constexpr int kScotch = 3, kSkipWhatNoLoadReaches = 3, kBestLoadsAtOnce = 64;
constexpr std::array kWantsMoreWorkspace{-8, -9};
constexpr std::array kOutOfMemory{-7, -8, -9, -13, -19};
constexpr std::array kSingular{-6, -10};

template <std::size_t kCount>
bool is_one_of(int error, const std::array<int, kCount>& errors) {
  return std::find(errors.begin(), errors.end(), error) != errors.end();
}

/// Do the nodes span an area? On a point or a line the body could still turn.
bool hold_still(const TetMesh& mesh, const std::vector<std::uint32_t>& fixed) {
  if (fixed.empty()) return false;
  const Vec3 o = mesh.node_m[fixed[0]];
  Vec3 far{};
  for (const std::uint32_t node : fixed)
    if (norm(mesh.node_m[node] - o) > norm(far)) far = mesh.node_m[node] - o;
  return std::any_of(fixed.begin(), fixed.end(), [&](std::uint32_t node) {
    // Chosen: off the line by more than rounding.
    return norm(cross(far, mesh.node_m[node] - o)) > 1e-6 * dot(far, far);
  });
}

/// The columns of loads as MUMPS takes them: no unknown twice in one.
struct SparseLoads {
  std::vector<int> first{1}, row;
  std::vector<double> value;

  void add(std::vector<std::pair<int, double>> column) {
    std::sort(column.begin(), column.end());
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (i > 0 && column[i].first == column[i - 1].first) {
        value.back() += column[i].second;
        continue;
      }
      row.push_back(column[i].first);
      value.push_back(column[i].second);
    }
    first.push_back(static_cast<int>(row.size()) + 1);
  }
};

}  // namespace

struct LinearSolver::Factor {
  FreeNodes free;
  DMUMPS_STRUC_C mumps{};

  Factor() {
    mumps.sym = 1;  // positive definite
    mumps.par = 1;
    mumps.comm_fortran = kThisProcess;
    run(Job::kBegin);
    std::fill_n(mumps.icntl + kPrint - 1, 4, 0);
    set(kOrdering, kScotch);
    set(kLoadsAtOnce, kBestLoadsAtOnce);
    set(kSparseLoads, kSkipWhatNoLoadReaches);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;
  ~Factor() { run(Job::kEnd); }

  void set(int control, int value) { mumps.icntl[control - 1] = value; }
  /// 0, or the number of the error.
  int run(Job job) {
    mumps.job = static_cast<int>(job);
    dmumps_c(&mumps);
    return std::min(mumps.infog[0], 0);
  }
  bool is_fixed(std::uint32_t node) const { return free.first_unknown[node] == FreeNodes::kFixed; }
  /// 0, or the number of the error.
  int factor(const StiffnessMatrix& matrix);
};

int LinearSolver::Factor::factor(const StiffnessMatrix& matrix) {
  std::vector<int> row, column;
  std::vector<double> value;
  for (int c = 0; c < matrix.outerSize(); ++c)
    for (StiffnessMatrix::InnerIterator entry(matrix, c); entry; ++entry)
      if (entry.row() >= entry.col()) {
        row.push_back(static_cast<int>(entry.row()) + 1);
        column.push_back(static_cast<int>(entry.col()) + 1);
        value.push_back(entry.value());
      }
  mumps.n = static_cast<int>(matrix.rows());
  mumps.nnz = static_cast<MUMPS_INT8>(value.size());
  mumps.irn = row.data(), mumps.jcn = column.data(), mumps.a = value.data();
  int error = run(Job::kAnalyse);
  // Its estimate of the memory may be too small.
  for (int more_percent = 20; error == 0 && more_percent <= 320; more_percent *= 2) {
    set(kMoreMemory_percent, more_percent);
    const int failed = run(Job::kFactor);
    if (!is_one_of(failed, kWantsMoreWorkspace) || more_percent == 320) {
      error = failed;
      break;
    }
  }
  mumps.irn = mumps.jcn = nullptr, mumps.a = nullptr;
  return error;
}

LinearSolver::LinearSolver(std::unique_ptr<Factor> factor) : factor_(std::move(factor)) {}
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;
LinearSolver::~LinearSolver() = default;

void LinearSolver::solve(std::span<const std::vector<NodeLoad>> loads,
                         std::span<const std::uint32_t> wanted,
                         std::span<std::vector<Vec3>> displacement_m) {
  Factor& f = *factor_;
  SparseLoads sparse;
  for (const std::vector<NodeLoad>& load : loads) {
    std::vector<std::pair<int, double>> column;
    for (const NodeLoad& one : load) {
      if (f.is_fixed(one.node)) continue;
      const int x = f.free.first_unknown[one.node] + 1;
      column.insert(column.end(),
                    {{x, one.force_N.x}, {x + 1, one.force_N.y}, {x + 2, one.force_N.z}});
    }
    sparse.add(std::move(column));
  }
  const auto unknowns = static_cast<std::size_t>(f.mumps.n);
  std::vector<double> solution(unknowns * loads.size());
  if (!sparse.row.empty()) {
    f.mumps.nrhs = static_cast<int>(loads.size());
    f.mumps.lrhs = f.mumps.n;
    f.mumps.rhs = solution.data();
    f.mumps.nz_rhs = static_cast<int>(sparse.row.size());
    f.mumps.irhs_ptr = sparse.first.data(), f.mumps.irhs_sparse = sparse.row.data();
    f.mumps.rhs_sparse = sparse.value.data();
    if (const int error = f.run(Job::kSolve); error != 0)
      end_with(fmt::format("finite elements: MUMPS cannot solve, error {}", error));
  }
  for (std::size_t c = 0; c < loads.size(); ++c) {
    displacement_m[c].assign(wanted.size(), {});
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (f.is_fixed(wanted[i])) continue;
      const double* u_m = solution.data() + c * unknowns + f.free.first_unknown[wanted[i]];
      displacement_m[c][i] = {u_m[0], u_m[1], u_m[2]};
    }
  }
}

int LinearSolver::place_of(std::uint32_t node) const {
  return factor_->is_fixed(node) ? 0 : factor_->mumps.sym_perm[factor_->free.first_unknown[node]];
}

Result<LinearSolver> make_linear_solver(const TetMesh& mesh, const Elasticity& material,
                                        const std::vector<std::uint32_t>& fixed) {
  const Error loose{
      "finite elements: the body is not held, or a node belongs to no element; make the box from "
      "elastic.fixed_min_m to elastic.fixed_max_m hold at least one triangle of the surface"};
  if (!hold_still(mesh, fixed)) return loose;
  auto factor = std::make_unique<LinearSolver::Factor>();
  factor->free = free_nodes(mesh.node_m.size(), fixed);
  if (factor->free.unknowns == 0)
    return Error{
        "finite elements: every node is held; make the box from elastic.fixed_min_m to "
        "elastic.fixed_max_m smaller"};
  const auto matrix = assemble_stiffness(mesh, material, factor->free);
  if (!matrix) return matrix.error();
  const int error = factor->factor(*matrix);
  if (is_one_of(error, kOutOfMemory))
    return Error{fmt::format(
        "finite elements: no memory for {} unknowns; take a coarser mesh or close programs",
        factor->free.unknowns)};
  // Not positive definite: a part of the body can move without force.
  if (is_one_of(error, kSingular) || factor->mumps.infog[kNegativePivots - 1] > 0) return loose;
  if (error != 0)
    return Error{fmt::format("finite elements: MUMPS cannot factor, error {}", error)};
  return LinearSolver(std::move(factor));
}

}  // namespace tact::model::fem
