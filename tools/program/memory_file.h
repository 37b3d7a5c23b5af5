// SPDX-License-Identifier: Apache-2.0
// memory_file.h - a file in no folder, for a program that we run: gone when the last that has it
// open ends, however it ends.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "model/result.h"

namespace tact::tools::program {

class MemoryFile {
 public:
  static model::Result<MemoryFile> make();
  MemoryFile(MemoryFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  MemoryFile& operator=(MemoryFile&&) = delete;
  ~MemoryFile();

  /// Names it for us and for every program that we start while it is here, and for nobody else.
  std::string path() const;
  /// At its end.
  std::optional<model::Error> put(std::string_view bytes) const;

 private:
  explicit MemoryFile(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace tact::tools::program
