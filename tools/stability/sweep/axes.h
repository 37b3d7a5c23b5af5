// SPDX-License-Identifier: Apache-2.0
// axes.h - a grid of settings as one row of jobs: job number to one index per axis.
#pragma once

#include <array>
#include <cstddef>

namespace tact::tools::stability {

template <std::size_t N>
struct Axes {
  std::array<std::size_t, N> size{};

  std::size_t jobs() const {
    std::size_t all = 1;
    for (const std::size_t s : size) all *= s;
    return all;
  }
  /// The last axis runs fastest.
  std::array<std::size_t, N> at(std::size_t job) const {
    std::array<std::size_t, N> index{};
    for (std::size_t i = N; i-- > 0;) {
      index[i] = job % size[i];
      job /= size[i];
    }
    return index;
  }
};

}  // namespace tact::tools::stability
