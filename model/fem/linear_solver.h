// SPDX-License-Identifier: Apache-2.0
// linear_solver.h - a linear elastic body, factored once, then solved for any loads: K u = f.
//
// Sparse Cholesky K = P' L L' P over the free nodes with a nested-dissection order (METIS). Several
// loads at once cost little more than one, because L is read once for all of them. Also the plain
// way to do haptics with finite elements: one whole solve a tick, the peer that the compliance law
// is compared with. Offline only: solve() allocates nothing after the first call of a width, but
// takes as long as the body is large.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/fem/elasticity.h"

namespace tact::model::fem {

inline constexpr std::size_t kLoadsAtOnce = 16;

/// A force on one node, N.
struct NodeLoad {
  std::uint32_t node = 0;
  Vec3 force_N{};
};

class LinearSolver {
 public:
  LinearSolver(LinearSolver&&) noexcept;
  LinearSolver& operator=(LinearSolver&&) noexcept;
  ~LinearSolver();

  /// At most kLoadsAtOnce loads: displacement_m[load] has one entry per node of `wanted`. Forces on
  /// fixed nodes do nothing.
  void solve(std::span<const std::vector<NodeLoad>> loads, std::span<const std::uint32_t> wanted,
             std::span<std::vector<Vec3>> displacement_m);

 private:
  friend Result<LinearSolver> make_linear_solver(const TetMesh&, const Elasticity&,
                                                 const std::vector<std::uint32_t>&);
  struct Factor;
  explicit LinearSolver(std::unique_ptr<Factor> factor);
  std::unique_ptr<Factor> factor_;
};

/// `fixed`: nodes that do not move. An error if the body is not held, or an element is bad.
Result<LinearSolver> make_linear_solver(const TetMesh& mesh, const Elasticity& material,
                                        const std::vector<std::uint32_t>& fixed);

}  // namespace tact::model::fem
