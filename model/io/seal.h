// SPDX-License-Identifier: Apache-2.0
// seal.h - the end of a finished file: how long it is, and the SHA-256 of all before.
//
// A binary file ends with 48 bytes: "tactseal", the number of bytes before as uint64, their digest.
// A text that is TOML ends with the line sha256 = "...", of all before that line. One flipped bit
// or one missing byte anywhere is seen. What is good of a damaged file its own checksums say, block
// by block. By OpenSSL's libcrypto; against accidents, not against malice.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"

struct evp_md_ctx_st;

namespace tact::model::io {

inline constexpr std::size_t kSealBytes = 48;

class Seal {
 public:
  Seal();
  void add(std::string_view bytes);
  /// The end of the file, of what was added so far.
  std::string bytes() const;
  /// 64 hex digits.
  std::string hex() const;

 private:
  struct Closer {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::array<unsigned char, 32> digest() const;

  std::unique_ptr<evp_md_ctx_st, Closer> context_;
  std::uint64_t count_ = 0;
};

/// The digest of these bytes: 64 hex digits in lower case.
std::string sha256_of(std::string_view bytes);

/// A file that grows (FileWriter::create) and is sealed at its end.
class SealedWriter {
 public:
  static Result<SealedWriter> create(const std::string& path);
  std::optional<Error> put(std::string_view bytes);
  std::optional<Error> flush() { return file_.flush(); }
  std::optional<Error> finish();

 private:
  explicit SealedWriter(FileWriter file) : file_(std::move(file)) {}

  FileWriter file_;
  Seal seal_;
};

/// Such a file, from its start to its seal; one without a seal, to its end.
class SealedFile {
 public:
  static Result<SealedFile> open(const std::string& path, std::string_view remedy);
  /// Without the seal.
  std::uint64_t size_bytes() const { return size_bytes_; }
  /// How many bytes there were, at most `bytes`.
  std::size_t read(void* to, std::size_t bytes);
  /// False if the file ends before.
  bool skip(std::uint64_t bytes);
  /// Reads what is left. Empty, or what is wrong with the file as a whole.
  std::string damage();

 private:
  SealedFile(InputFile file, std::uint64_t size_bytes, std::string seal)
      : file_(std::move(file)), size_bytes_(size_bytes), seal_(std::move(seal)) {}

  InputFile file_;
  std::uint64_t size_bytes_ = 0, read_bytes_ = 0;
  std::string seal_, failed_;  // what the file ends with; why a read failed
  Seal own_;
};

/// TOML without sections, and the line that seals it.
std::string sealed_text(const std::string& text);
/// Is it what sealed_text made?
bool is_sealed(std::string_view text);

}  // namespace tact::model::io
