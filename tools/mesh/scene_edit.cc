// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/scene_edit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/io/toml.h"

namespace tact::tools::mesh {
namespace {

using model::Error;
using model::Result;

constexpr const char* kRemedy = "run it without --write, and write the printed lines yourself";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string trimmed(std::string line) {
  line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
  return line;
}

bool is_key(const std::string& line, const std::string& key) {
  std::string rest = trimmed(line);
  if (!rest.starts_with(key)) return false;
  rest = trimmed(rest.substr(key.size()));
  return rest.starts_with("=");
}

/// Does a value go on in the next line?
bool is_open(const std::string& line) {
  return std::count(line.begin(), line.end(), '[') > std::count(line.begin(), line.end(), ']') ||
         line.find("\"\"\"") != std::string::npos || line.find("'''") != std::string::npos;
}

std::optional<Error> set_keys(std::vector<std::string>& lines, const std::string& section,
                              const std::vector<KeyValue>& keys) {
  const auto header = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return trimmed(line).starts_with("[" + section + "]");
  });
  if (header == lines.end())
    return Error{fmt::format("the scene has no line [{}]; {}", section, kRemedy)};
  auto at = header - lines.begin();
  for (const auto& [key, value] : keys) {
    const auto begin = header + 1;
    const auto end = std::find_if(
        begin, lines.end(), [](const std::string& line) { return trimmed(line).starts_with("["); });
    const std::string text = fmt::format("{} = {}", key, value);
    const auto found = std::find_if(
        begin, end, [&key = key](const std::string& line) { return is_key(line, key); });
    if (found == end) continue;
    if (is_open(*found))
      return Error{fmt::format("{}.{} goes over several lines; {}", section, key, kRemedy)};
    *found = text;
    at = std::max(at, found - lines.begin());
  }
  for (const auto& [key, value] : keys) {
    const auto first = lines.begin() + (header - lines.begin()) + 1;
    const bool there = std::any_of(first, lines.begin() + at + 1,
                                   [&key = key](const std::string& l) { return is_key(l, key); });
    if (!there) lines.insert(lines.begin() + ++at, fmt::format("{} = {}", key, value));
  }
  return std::nullopt;
}

/// Does the text say what it said before, but for these values? A key may be written in a way that
/// the lines do not show.
Result<bool> changes_nothing_else(const std::string& before, const std::string& after,
                                  const Placement& placement) {
  auto wanted = model::io::parse_toml(before, "the scene");
  if (!wanted) return wanted.error();
  const auto values = model::io::parse_toml(toml_of(placement), "the placement");
  if (!values) return values.error();
  for (const auto& [section, keys] : *values)
    for (const auto& [key, value] : *keys.as_table())
      if (toml::table* of = (*wanted)[section.str()].as_table()) of->insert_or_assign(key, value);
  const auto is = model::io::parse_toml(after, "the new text");
  return is && *is == *wanted;
}

}  // namespace

Result<std::string> placed_in(const std::string& scene_text, const Placement& placement) {
  std::vector<std::string> lines = lines_of(scene_text);
  if (const auto error = set_keys(lines, "organ", organ_keys(placement))) return *error;
  if (const auto error = set_keys(lines, "hand", hand_keys(placement))) return *error;
  std::string text = fmt::format("{}\n", fmt::join(lines, "\n"));
  const auto sound = changes_nothing_else(scene_text, text, placement);
  if (!sound) return sound.error();
  if (!*sound)
    return Error{fmt::format(
        "the keys of [organ] or [hand] stand in a form that is not understood; {}", kRemedy)};
  return text;
}

std::optional<Error> write_placement(const std::string& scene_path, const Placement& placement) {
  const auto before = model::io::read_file(scene_path);
  if (!before) return before.error();
  const auto after = placed_in(*before, placement);
  if (!after) return Error{fmt::format("{}: {}", scene_path, after.error().message)};
  return model::io::write_file(scene_path, *after);
}

}  // namespace tact::tools::mesh
