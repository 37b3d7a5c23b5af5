// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/library_trust.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

namespace tact::hal::vendor_sdk {
namespace {

using model::Error;
using model::Result;
using std::filesystem::path;

// By parts of the path, not by letters: /optional is not below /opt.
bool lies_below(const path& file, const path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

/// Whose it is and who else may write it.
std::optional<std::string> fault_of(const path& part, bool is_file, const LibraryFolders& folders) {
  struct stat info{};
  if (stat(part.c_str(), &info) != 0)
    return fmt::format("{}: {}", part.string(), std::strerror(errno));
  if (is_file && !S_ISREG(info.st_mode)) return "it is no file";
  const unsigned mode = info.st_mode & 07777u;
  if (info.st_uid != folders.owner)
    return fmt::format("{} belongs to user {} (mode {:04o}), not to root", part.string(),
                       info.st_uid, mode);
  if ((mode & 022u) != 0)
    return fmt::format("others than its owner may write {} (owner {}, mode {:04o})", part.string(),
                       info.st_uid, mode);
  return std::nullopt;
}

}  // namespace

LibraryFolders system_folders() {
  LibraryFolders folders{.searched = {}, .allowed = {"/usr", "/lib", "/lib64", "/opt"}};
  for (const char* folder : {"/usr/local/lib", "/lib", "/usr/lib", "/lib64", "/usr/lib64"}) {
    folders.searched.emplace_back(folder);
#if defined(__x86_64__)
    folders.searched.push_back(std::string(folder) + "/x86_64-linux-gnu");
#elif defined(__aarch64__)
    folders.searched.push_back(std::string(folder) + "/aarch64-linux-gnu");
#endif
  }
  return folders;
}

Result<std::string> find_library(const std::string& name, const LibraryFolders& folders) {
  std::error_code failed;
  if (name.find('/') != std::string::npos) {
    // Links followed first: what is judged is what will be loaded.
    const path file = std::filesystem::canonical(name, failed);
    if (failed) return Error{fmt::format("{}: {}", name, failed.message())};
    return file.string();
  }
  for (const std::string& folder : folders.searched)
    if (const path file = std::filesystem::canonical(path(folder) / name, failed); !failed)
      return file.string();
  return Error{fmt::format("{}: in no system folder", name)};
}

std::optional<Error> distrust_library(const std::string& file, const std::string& remedy,
                                      const LibraryFolders& folders) {
  const auto refused = [&](const std::string& why) {
    return Error{fmt::format("{} is not loaded, {}: {}", file, why, remedy)};
  };
  const bool allowed = std::ranges::any_of(
      folders.allowed, [&](const std::string& folder) { return lies_below(file, folder); });
  if (!allowed) return refused("as it lies below no system folder, nor /opt");
  // Every folder up to the top: a user who may write one can put another file in its place.
  for (path part = file; part == folders.top || lies_below(part, folders.top);
       part = part.parent_path()) {
    if (const auto why = fault_of(part, part == file, folders)) return refused(*why);
    if (part == part.root_path()) break;
  }
  return std::nullopt;
}

}  // namespace tact::hal::vendor_sdk
