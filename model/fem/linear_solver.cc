// SPDX-License-Identifier: Apache-2.0
#include "model/fem/linear_solver.h"

// MetisSupport uses std::cerr without including it.
// clang-format off
#include <iostream>
#include <Eigen/MetisSupport>
// clang-format on
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace tact::model::fem {
namespace {

using Cholesky = Eigen::SimplicialLLT<StiffnessMatrix, Eigen::Lower,
                                      Eigen::MetisOrdering<StiffnessMatrix::StorageIndex>>;

/// L x = f, then L' x = f, for all loads side by side: x[row * kLoadsAtOnce + load].
void solve_factored(const StiffnessMatrix& l, double* x) {
  constexpr int kWidth = kLoadsAtOnce;
  using Loads = Eigen::Array<double, kWidth, 1>;
  const auto at = [x](std::int64_t row) { return Eigen::Map<Loads>(x + row * kWidth); };
  // Own loops over L: Eigen would read it again for each
  // load, and it is what does not fit into a cache.
  const std::int32_t* start = l.outerIndexPtr();
  const std::int32_t* row = l.innerIndexPtr();
  const double* value = l.valuePtr();
  const std::int32_t n = static_cast<std::int32_t>(l.cols());
  for (std::int32_t j = 0; j < n; ++j) {  // the first entry of a column is its diagonal
    const Loads here = at(j) / value[start[j]];
    at(j) = here;
    for (std::int32_t p = start[j] + 1; p < start[j + 1]; ++p) at(row[p]) -= value[p] * here;
  }
  for (std::int32_t j = n - 1; j >= 0; --j) {
    Loads sum = at(j);
    for (std::int32_t p = start[j] + 1; p < start[j + 1]; ++p) sum -= value[p] * at(row[p]);
    at(j) = sum / value[start[j]];
  }
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

}  // namespace

struct LinearSolver::Factor {
  FreeNodes free;
  StiffnessMatrix lower;               // L
  std::vector<std::int32_t> position;  // of each unknown in L
  std::vector<double> work;

  // Where component i of the node begins in `work`; only for free nodes.
  std::size_t place(std::uint32_t node, std::size_t i) const {
    const auto unknown = static_cast<std::size_t>(free.first_unknown[node]) + i;
    return static_cast<std::size_t>(position[unknown]) * kLoadsAtOnce;
  }
  bool is_fixed(std::uint32_t node) const { return free.first_unknown[node] == FreeNodes::kFixed; }
  void add(std::span<const NodeLoad> load, std::size_t column) {
    for (const NodeLoad& one : load) {
      if (is_fixed(one.node)) continue;
      work[place(one.node, 0) + column] += one.force_N.x;
      work[place(one.node, 1) + column] += one.force_N.y;
      work[place(one.node, 2) + column] += one.force_N.z;
    }
  }
  Vec3 displacement_m(std::uint32_t node, std::size_t column) const {
    if (is_fixed(node)) return {};
    return {work[place(node, 0) + column], work[place(node, 1) + column],
            work[place(node, 2) + column]};
  }
};

LinearSolver::LinearSolver(std::unique_ptr<Factor> factor) : factor_(std::move(factor)) {}
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;
LinearSolver::~LinearSolver() = default;

void LinearSolver::solve(std::span<const std::vector<NodeLoad>> loads,
                         std::span<const std::uint32_t> wanted,
                         std::span<std::vector<Vec3>> displacement_m) {
  Factor& f = *factor_;
  // All columns, those without a load too: the width is fixed, so that the compiler can unroll it.
  f.work.assign(f.position.size() * kLoadsAtOnce, 0.0);
  for (std::size_t c = 0; c < loads.size(); ++c) f.add(loads[c], c);
  solve_factored(f.lower, f.work.data());
  for (std::size_t c = 0; c < loads.size(); ++c) {
    displacement_m[c].resize(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      displacement_m[c][i] = f.displacement_m(wanted[i], c);
  }
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
  const Cholesky cholesky(*matrix);
  // Not positive definite: a part of the body can move without force.
  if (cholesky.info() != Eigen::Success) return loose;
  factor->lower = cholesky.matrixL().nestedExpression();
  const auto& order = cholesky.permutationP().indices();
  factor->position.assign(order.data(), order.data() + order.size());
  return LinearSolver(std::move(factor));
}

}  // namespace tact::model::fem
