// SPDX-License-Identifier: Apache-2.0
#include "host/server/page_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "model/io/input_file.h"

namespace tact::host::server {
namespace {

using model::Error;

// Chosen: a larger folder is the wrong one, such as /.
constexpr std::uintmax_t kMaxPageBytes = 64 << 20;

std::string mime_of(const std::filesystem::path& path) {
  static constexpr std::pair<const char*, const char*> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".woff2", "font/woff2"},
  };
  for (const auto& [ending, mime] : kTypes)
    if (path.extension() == ending) return mime;
  return "application/octet-stream";
}

}  // namespace

std::optional<Error> PageFiles::load(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code wrong;
  std::uintmax_t total_bytes = 0;
  files_.clear();
  // Links are not followed: only files of this folder are served.
  for (fs::recursive_directory_iterator it(folder, wrong), end; !wrong && it != end;
       it.increment(wrong)) {
    if (it->is_symlink(wrong) || !it->is_regular_file(wrong)) continue;
    total_bytes += it->file_size(wrong);
    if (total_bytes > kMaxPageBytes)
      return Error{
          fmt::format("{}: more than 64 MiB of files; give the folder of the built page", folder)};
    auto content = model::io::read_file(it->path().string());
    if (!content) return content.error();
    const std::string url = "/" + it->path().lexically_relative(folder).generic_string();
    files_[url] = {mime_of(it->path()), std::move(*content)};
  }
  if (find("/") == nullptr)
    return Error{
        fmt::format("{}: no page there; build it from the sources, or name one by --page", folder)};
  return std::nullopt;
}

const PageFile* PageFiles::find(std::string_view path) const {
  const auto it = files_.find(path == "/" ? std::string_view("/index.html") : path);
  return it == files_.end() ? nullptr : &it->second;
}

}  // namespace tact::host::server
