// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "model/io/file_writer.h"
#include "tools/program/program.h"

namespace tact::tools::new_scene {

namespace fs = std::filesystem;
using model::Error;

model::Result<OutputNames> names_of(const std::string& out) {
  const fs::path path(out);
  if (path.extension() != ".toml" || path.stem().empty())
    return Error{fmt::format("{}: a scene's name ends in .toml; write --out mine.toml", out)};
  const std::string stem = path.stem().string();
  // A scene's text would not take it.
  if (std::any_of(stem.begin(), stem.end(), [](unsigned char c) { return c < ' ' || c == 0x7F; }))
    return Error{"the scene's name has a control character; choose another --out"};
  const auto beside = [&](const std::string& ending) {
    return (path.parent_path() / (stem + ending)).string();
  };
  return OutputNames{.scene = out,
                     .map = beside(".compliance"),
                     .organ = beside(".obj"),
                     .tool = beside("_tool.obj"),
                     .reference = beside(".reference.json"),
                     .tool_reference = beside("_tool.reference.json"),
                     .name = stem};
}

std::optional<Error> check_new(const std::string& path, const std::string& beginning,
                               const std::string& source, bool force) {
  std::error_code failed;
  if (!force && fs::exists(fs::symlink_status(path, failed)))
    return Error{fmt::format("{}: exists already; choose another --out, or add --force", path)};
  return program::check_output(path, beginning, {source});
}

std::optional<Error> write_all(const std::vector<OutputFile>& files, bool force) {
  std::vector<model::io::FileWriter> writers;
  for (const OutputFile& file : files) {
    auto writer = force ? model::io::FileWriter::replace(file.path, file.content)
                        : model::io::FileWriter::add(file.path);
    if (!writer) return writer.error();
    if (auto error = writer->put(file.content)) return error;
    if (auto error = writer->flush()) return error;
    writers.push_back(std::move(*writer));
  }
  for (std::size_t i = 0; i < writers.size(); ++i) {
    auto error = writers[i].finish();
    if (!error) continue;
    // What replaced nothing goes again.
    std::error_code ignored;
    for (std::size_t made = 0; made < i && !force; ++made) fs::remove(files[made].path, ignored);
    return error;
  }
  return std::nullopt;
}

}  // namespace tact::tools::new_scene
