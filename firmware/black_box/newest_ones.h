// SPDX-License-Identifier: Apache-2.0
// newest_ones.h - a ring buffer of the newest items, oldest first; allocated once, at the start.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tact::firmware::black_box {

template <typename T>
class NewestOnes {
 public:
  explicit NewestOnes(std::size_t most) : items_(std::max<std::size_t>(most, 1)) {}

  void add(const T& item) {
    items_[next_] = item;
    next_ = (next_ + 1) % items_.size();
    size_ = std::min(size_ + 1, items_.size());
  }
  /// Takes the memory that copy_to() needs.
  void reserve(std::vector<T>& out) const { (out = items_).clear(); }
  /// Oldest first.
  void copy_to(std::vector<T>& out) const {
    out.clear();
    for (std::size_t i = 0; i < size_; ++i)
      out.push_back(items_[(next_ + items_.size() - size_ + i) % items_.size()]);
  }

 private:
  std::vector<T> items_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace tact::firmware::black_box
