// SPDX-License-Identifier: Apache-2.0
// input_file.h - the one way to read a file: regular files only, up to a size, errors reported.
//
// A pipe, a socket or a device is refused before it is opened: opening one can wait for ever or
// change it. A read that fails is an error, never a shorter text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "model/result.h"

namespace tact::model::io {

inline constexpr std::uintmax_t kMaxBytes = 1'000'000'000;

/// A regular file, read from its start on.
class InputFile {
 public:
  /// An error is "PATH: what is wrong; REMEDY".
  static Result<InputFile> open(const std::string& path, std::string_view remedy);
  InputFile(InputFile&& other) noexcept
      : path_(std::move(other.path_)),
        remedy_(std::move(other.remedy_)),
        fd_(std::exchange(other.fd_, -1)),
        size_bytes_(other.size_bytes_) {}
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  /// When it was opened; 0 in /proc and /sys, which say no size.
  std::uintmax_t size_bytes() const { return size_bytes_; }
  /// How many bytes there were, at most `bytes`; fewer only at the end of the file.
  Result<std::size_t> read(void* to, std::size_t bytes);
  /// Its last bytes, or all of a shorter file; the next read() begins at the start.
  Result<std::size_t> read_end(void* to, std::size_t bytes);

 private:
  InputFile(std::string path, std::string remedy, int fd, std::uintmax_t size_bytes)
      : path_(std::move(path)), remedy_(std::move(remedy)), fd_(fd), size_bytes_(size_bytes) {}

  std::string path_, remedy_;
  int fd_ = -1;
  std::uintmax_t size_bytes_ = 0;
};

/// All of a file; an error is "PATH: what is wrong; REMEDY".
Result<std::string> read_file(const std::string& path, std::string_view remedy = "check the name",
                              std::uintmax_t most_bytes = kMaxBytes);

}  // namespace tact::model::io
