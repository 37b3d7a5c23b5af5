// SPDX-License-Identifier: Apache-2.0
// linear_solver.h - a linear elastic body, factored once, then solved for any loads: K u = f.
//
// Sparse K = L D L' over the free nodes by MUMPS, which skips the part of L that a local load does
// not reach. Measured against Eigen and SuperLU: model/decisions.md. Offline only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/fem/elasticity.h"

namespace tact::model::fem {

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

  /// displacement_m[load] has one entry per node of `wanted`. Several loads at once cost less than
  /// each alone: about 64 are best. Forces on fixed nodes do nothing. One thread at a time, in all
  /// of the program: MUMPS has state of its own.
  void solve(std::span<const std::vector<NodeLoad>> loads, std::span<const std::uint32_t> wanted,
             std::span<std::vector<Vec3>> displacement_m);
  /// Where elimination has this node; one order for all nodes. Held nodes: 0.
  int place_of(std::uint32_t node) const;

 private:
  friend Result<LinearSolver> make_linear_solver(const TetMesh&, const Elasticity&,
                                                 const std::vector<std::uint32_t>&);
  struct Factor;
  explicit LinearSolver(std::unique_ptr<Factor> factor);
  std::unique_ptr<Factor> factor_;
};

/// `fixed`: nodes that do not move. An error if the body is not held, an element is bad, or memory
/// is short.
Result<LinearSolver> make_linear_solver(const TetMesh& mesh, const Elasticity& material,
                                        const std::vector<std::uint32_t>& fixed);

}  // namespace tact::model::fem
