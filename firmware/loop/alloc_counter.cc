// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/alloc_counter.h"

#include <cerrno>
#include <cstddef>

// Detects sanitizers that replace malloc: gcc defines a macro, clang has __has_feature.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TACT_HEAP_HAS_HOOKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TACT_HEAP_HAS_HOOKS
#elif __has_feature(realtime_sanitizer)
#define TACT_HEAP_IS_TAKEN
#endif
#endif

#ifdef TACT_HEAP_HAS_HOOKS
#define TACT_HEAP_IS_TAKEN
#if __has_include(<sanitizer/allocator_interface.h>)  // clang's; gcc has none
#include <sanitizer/allocator_interface.h>
#define TACT_HEAP_IS_HOOKED
#endif
#endif

namespace tact::firmware::loop {
namespace {

// Constant initialisers, so the first access in a thread runs no code and allocates nothing.
thread_local bool watching = false;
thread_local std::uint64_t counted = 0;

[[maybe_unused]] inline void note_heap_call() {
  if (watching) ++counted;
}

#ifdef TACT_HEAP_IS_HOOKED
void on_malloc(const volatile void*, std::size_t) { note_heap_call(); }
void on_free(const volatile void*) { note_heap_call(); }
const bool counts = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
#elif defined(TACT_HEAP_IS_TAKEN)
const bool counts = false;
#else
const bool counts = true;
#endif

}  // namespace

bool can_count_heap_calls() { return counts; }

#ifdef TACT_HEAP_IS_TAKEN
bool is_sanitized() { return true; }
#else
bool is_sanitized() { return false; }
#endif

HeapCallCounter::HeapCallCounter() {
  counted = 0;
  watching = true;
}
HeapCallCounter::~HeapCallCounter() { watching = false; }
std::uint64_t HeapCallCounter::calls() const { return counted; }

}  // namespace tact::firmware::loop

#ifndef TACT_HEAP_IS_TAKEN
using tact::firmware::loop::note_heap_call;

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): glibc's own names
// Declared here, because dlsym would allocate within malloc.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) {
  note_heap_call();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note_heap_call();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  note_heap_call();
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note_heap_call();
  return __libc_memalign(alignment, size);
}
// Both call memalign, which counts once.
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  *out = memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* block) {
  note_heap_call();
  __libc_free(block);
}
}  // extern "C"
#endif
