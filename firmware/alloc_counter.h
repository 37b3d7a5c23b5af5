// alloc_counter.h - counts what the loop must never do: heap calls of one thread.
//
// The program's malloc, calloc, realloc, aligned forms and free pass through here on their way to
// glibc (operator new ends in malloc). A thread that watches itself counts its own calls; others
// pay one test of a thread-local flag. Absent under sanitizers, which interpose the same names.
#pragma once

#include <cstdint>

namespace tact::firmware {

/// False in builds where heap calls cannot be counted (sanitizers).
bool can_count_heap_calls();

/// Counts the heap calls of this thread while it lives.
class HeapWatch {
 public:
  HeapWatch();
  ~HeapWatch();
  HeapWatch(const HeapWatch&) = delete;
  HeapWatch& operator=(const HeapWatch&) = delete;
  std::uint64_t calls() const;
};

}  // namespace tact::firmware
