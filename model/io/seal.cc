// SPDX-License-Identifier: Apache-2.0
#include "model/io/seal.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstring>

namespace tact::model::io {
namespace {

constexpr std::string_view kMagic = "tactseal";
constexpr std::size_t kBlock_bytes = 1 << 16;
static_assert(kSealBytes == kMagic.size() + sizeof(std::uint64_t) + 32);

}  // namespace

void Seal::Closer::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Seal::Seal() : context_(EVP_MD_CTX_new()) {
  EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
}

void Seal::add(std::string_view bytes) {
  EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  count_ += bytes.size();
}

std::array<unsigned char, 32> Seal::digest() const {
  std::array<unsigned char, 32> out{};
  // Of a copy: ending a digest ends its context, and more bytes may come.
  const std::unique_ptr<evp_md_ctx_st, Closer> copy(EVP_MD_CTX_new());
  EVP_MD_CTX_copy_ex(copy.get(), context_.get());
  EVP_DigestFinal_ex(copy.get(), out.data(), nullptr);
  return out;
}

std::string Seal::bytes() const {
  const auto sum = digest();
  std::string out(kMagic);
  out.append(reinterpret_cast<const char*>(&count_), sizeof count_);
  return out.append(reinterpret_cast<const char*>(sum.data()), sum.size());
}

std::string Seal::hex() const {
  std::string out;
  for (const unsigned char byte : digest()) out += fmt::format("{:02x}", byte);
  return out;
}

Result<SealedWriter> SealedWriter::create(const std::string& path) {
  auto file = FileWriter::create(path);
  if (!file) return file.error();
  return SealedWriter(std::move(*file));
}

std::optional<Error> SealedWriter::put(std::string_view bytes) {
  seal_.add(bytes);
  return file_.put(bytes);
}

std::optional<Error> SealedWriter::finish() {
  if (auto error = file_.put(seal_.bytes())) return error;
  return file_.finish();
}

Result<SealedFile> SealedFile::open(const std::string& path, std::string_view remedy) {
  auto file = InputFile::open(path, remedy);
  if (!file) return file.error();
  std::string seal(kSealBytes, '\0');
  std::uint64_t size_bytes = file->size_bytes();
  const auto end = file->read_end(seal.data(), seal.size());
  if (!end) return end.error();
  // Without one it is read to its end all the same; damage() says so.
  if (*end == kSealBytes && seal.starts_with(kMagic))
    size_bytes -= kSealBytes;
  else
    seal.clear();
  return SealedFile(std::move(*file), size_bytes, std::move(seal));
}

std::size_t SealedFile::read(void* to, std::size_t bytes) {
  // Never into the seal: it is no part of what it seals.
  bytes = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, size_bytes_ - read_bytes_));
  const auto read = file_.read(to, bytes);
  if (!read) failed_ = read.error().message;
  const std::size_t got = read ? *read : 0;
  own_.add({static_cast<const char*>(to), got});
  read_bytes_ += got;
  return got;
}

bool SealedFile::skip(std::uint64_t bytes) {
  std::string block(kBlock_bytes, '\0');
  while (bytes > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, kBlock_bytes));
    const std::size_t got = read(block.data(), step);
    bytes -= got;
    if (got < step) return false;
  }
  return true;
}

std::string SealedFile::damage() {
  // The digest is of all bytes, also of those that were skipped.
  skip(size_bytes_ - read_bytes_);
  if (!failed_.empty()) return failed_;
  if (seal_.empty())
    return fmt::format("the file is cut off at byte {}, was not finished, or its end is damaged",
                       size_bytes_);
  if (seal_ != own_.bytes())
    return fmt::format("a byte is damaged: the SHA-256 of its {} bytes is another", size_bytes_);
  return {};
}

std::string sha256_of(std::string_view bytes) {
  Seal seal;
  seal.add(bytes);
  return seal.hex();
}

std::string sealed_text(const std::string& text) {
  return text + fmt::format("sha256 = \"{}\"\n", sha256_of(text));
}

bool is_sealed(std::string_view text) {
  // The last one: the text before may hold such a line of its own.
  const std::size_t at = text.rfind("sha256 = \"");
  return at != text.npos && sealed_text(std::string(text.substr(0, at))) == text;
}

}  // namespace tact::model::io
