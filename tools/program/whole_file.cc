// SPDX-License-Identifier: Apache-2.0
#include "tools/program/whole_file.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace tact::tools::program {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

Result<std::string> write_whole_file(const std::string& path, const std::string& content) {
  const std::string part = path + ".part";
  {
    std::ofstream stream(part, std::ios::binary);
    stream << content;
    if (!stream.flush())
      return Error{fmt::format("{}: cannot be written; check the folder and the space", path)};
  }
  std::error_code error;
  fs::rename(part, path, error);
  if (error) return Error{fmt::format("{}: {}", path, error.message())};
  return path;
}

Result<std::string> read_whole_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string content;
  std::array<char, 4096> block;
  while (stream.read(block.data(), block.size()), stream.gcount() > 0)
    content.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  if (!stream.eof()) return Error{fmt::format("{}: cannot be read", path)};
  return content;
}

}  // namespace tact::tools::program
