// SPDX-License-Identifier: Apache-2.0
// fuzz.h - what every fuzzer shares: bytes from anywhere, and rules that must hold.
//
// A fuzzer is tests/fuzz/NAME_fuzz.cc with libFuzzer's entry point; its corpus, the inputs that
// reach new code, is tests/fuzz/corpus/NAME.tar.xz. A rule that breaks traps, so that libFuzzer
// keeps the input. tools/check replays every corpus; with --long each fuzzer looks for new inputs
// for a minute. New ones come into an archive by
//   tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -cJf NAME.tar.xz -C FOLDER .
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tact::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A rule of what is under test.
inline void require(bool rule) {
  if (!rule) __builtin_trap();
}

/// Takes the next bytes off an input; fewer where it ends.
inline Bytes take(Bytes& input, std::size_t count) {
  const Bytes taken = input.first(std::min(count, input.size()));
  input = input.subspan(taken.size());
  return taken;
}

}  // namespace tact::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
