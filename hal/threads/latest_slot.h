// SPDX-License-Identifier: Apache-2.0
// latest_slot.h - the newest value from one thread to one other, without waiting on either side.
//
// Three buffers: the writer owns one, the reader owns one, the third lies between them. write and
// read each copy once and swap their buffer with the middle one in a single atomic exchange; a
// value that was not fetched is overwritten. Exactly one writer thread and one reader thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "model/rt.h"

namespace tact::hal::threads {

template <typename T>
class LatestSlot {
  static_assert(std::is_trivially_copyable_v<T>, "a copy must be plain bytes");
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

 public:
  LatestSlot() = default;
  LatestSlot(const LatestSlot&) = delete;
  LatestSlot& operator=(const LatestSlot&) = delete;

  /// Writer thread.
  void write(const T& value) RT_SAFE {
    buffers_[written_].value = value;
    // release: the value is in the buffer before its index is; acquire: the reader is done with
    // ours
    written_ = middle_.exchange(written_ | kNew, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader thread: true and the newest value, or false when there is none since the last read.
  bool read(T& value) RT_SAFE {
    if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    value = buffers_[read_].value;
    return true;
  }

 private:
  static constexpr std::uint8_t kIndex = 0x03;
  static constexpr std::uint8_t kNew = 0x04;
  struct alignas(64) Buffer {  // a cache line of its own
    T value{};
  };

  std::array<Buffer, 3> buffers_;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t written_ = 0;  // writer only
  alignas(64) std::uint8_t read_ = 2;     // reader only
};

}  // namespace tact::hal::threads
