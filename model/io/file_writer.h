// SPDX-License-Identifier: Apache-2.0
// file_writer.h - the one way to write a file: all of it or nothing, never over something else.
//
// A regular file appears in one step: a temporary beside it, fsync, rename. An existing one is
// replaced only if it is empty or begins as the new content does: with the '{' of JSON, else with
// the same first 16 bytes, up to a comma, a colon or the end of the line. So a result replaces an
// earlier result, and no scene or mesh whose name was given by mistake. Pipes and character devices
// are written straight. Folders, block devices and sockets are refused.
//
// What grows for hours (tick logs, recordings) is a new file under its own name, so that what was
// written is there after a crash; such a file is never written over.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "model/result.h"

namespace tact::model::io {

class FileWriter {
 public:
  /// A new file that grows under its own name.
  static Result<FileWriter> create(const std::string& path);
  /// All or nothing, by the rule above. `beginning`: of what will be put, at least 16 bytes of it.
  static Result<FileWriter> replace(const std::string& path, std::string_view beginning);
  FileWriter(FileWriter&& other) noexcept
      : path_(std::move(other.path_)),
        target_(std::move(other.target_)),
        part_(std::exchange(other.part_, {})),
        waiting_(std::move(other.waiting_)),
        fd_(std::exchange(other.fd_, -1)) {}
  FileWriter& operator=(FileWriter&& other) noexcept;
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  /// Without finish(), what replaces is gone; what grows keeps what was flushed.
  ~FileWriter();

  /// Buffered. An error is "PATH: what is wrong"; after one the file is as flush() left it.
  std::optional<Error> put(std::string_view bytes);
  /// Hands over to the kernel.
  std::optional<Error> flush();
  /// On the disk, under its name, closed.
  std::optional<Error> finish();

 private:
  FileWriter(std::string path, std::string target, std::string part, int fd)
      : path_(std::move(path)), target_(std::move(target)), part_(std::move(part)), fd_(fd) {}
  std::optional<Error> fail(int number);

  std::string path_;    // as it was named
  std::string target_;  // with links followed
  std::string part_;    // the temporary; empty where there is none
  std::string waiting_;
  int fd_ = -1;
};

/// All of it, by FileWriter::replace.
std::optional<Error> write_file(const std::string& path, std::string_view content);

/// Would write_file write there? For work that takes long; makes nothing.
std::optional<Error> check_target(const std::string& path, std::string_view beginning);

}  // namespace tact::model::io
