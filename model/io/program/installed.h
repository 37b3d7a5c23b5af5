// SPDX-License-Identifier: Apache-2.0
// installed.h - where an installed program finds what it reads: share/tact beside its bin.
#pragma once

#include <filesystem>
#include <system_error>

namespace tact::model::io {

/// The folder that holds the running program; empty where /proc does not name it.
inline std::filesystem::path program_folder() {
  std::error_code wrong;
  return std::filesystem::read_symlink("/proc/self/exe", wrong).parent_path();
}

/// PREFIX/share/tact/NAME of the program PREFIX/bin/...; it need not exist, as in a build folder.
inline std::filesystem::path installed(const std::filesystem::path& name) {
  return program_folder().parent_path() / "share" / "tact" / name;
}

/// NAME beside the program in a build folder, else where it is installed; empty if in neither.
inline std::filesystem::path data_file(const std::filesystem::path& name) {
  std::error_code failed;
  for (const std::filesystem::path& path : {program_folder() / name, installed(name)})
    if (std::filesystem::is_regular_file(path, failed)) return path;
  return {};
}

}  // namespace tact::model::io
