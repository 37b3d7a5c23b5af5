// SPDX-License-Identifier: Apache-2.0
#include "model/reader/scene_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "model/io/input_file.h"
#include "model/io/program/installed.h"
#include "model/io/toml.h"
#include "model/reader/scene_text.h"

namespace tact::model::reader {
namespace {

// A scene has some kilobytes: a megabyte is a file that was named by mistake.
constexpr std::uintmax_t kMaxFile_bytes = 1'000'000;

std::string remedy() {
  const auto installed = io::installed("scenes/liver.toml");
  std::error_code wrong;
  const bool there = std::filesystem::exists(installed, wrong);
  return "give the path of a scene, such as " +
         (there ? installed.string() : "model/scenes/liver.toml");
}

bool is_bare_word(std::string_view value) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  // What begins as a word or a path does; a broken number or quote must not become text.
  if (value.empty() || value.find_first_of("'\"") != value.npos) return false;
  return is_letter(value[0]) || value[0] == '/' || value[0] == '.' || value[0] == '_';
}

/// Checked before it becomes text for the parser: a key could else bring lines of its own.
bool is_key_path(std::string_view path) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !path.empty() && path.find_first_not_of(kAllowed) == path.npos && path.front() != '.' &&
         path.back() != '.' && path.find("..") == path.npos;
}

/// One "key.path=value" on its way into the document.
class Override {
 public:
  explicit Override(std::string_view text) : text_(text), where_("--set " + on_one_line(text)) {}

  /// The key and its value as TOML writes it: law=auto and law="auto" mean the same.
  const std::string& meaning() const { return meaning_; }

  std::optional<Error> lay_over(toml::table& root) {
    const std::size_t equals = text_.find('=');
    if (equals == text_.npos) return error("there is no '='", kShape);
    const std::string_view path = text_.substr(0, equals), value = text_.substr(equals + 1);
    if (!is_key_path(path)) return error("the key is no key path", kShape);
    for (const char c : value)
      if (c == '\n' || c == '\r') return error("the value has more than one line", kShape);
    rest_ = path;
    toml::node* parent = &root;
    if (auto failed = descend(parent)) return failed;
    if (!parent->is_table()) {
      return error("one element of an array cannot be set alone",
                   "set the whole array, or one key of an entry as in hand.stroke.0.duration_s=1");
    }
    return put(*parent->as_table(), value);
  }

 private:
  static constexpr std::string_view kShape =
      "write key.path=value, for example rhombus.units=8 or law=rhombus";

  Error error(std::string_view what, std::string_view remedy) const {
    return {fmt::format("{}: {}; {}", where_, what, remedy)};
  }

  /// As deep as the document goes; what it does not have stays in rest_.
  std::optional<Error> descend(toml::node*& parent) {
    for (std::size_t dot = rest_.find('.'); dot != rest_.npos; dot = rest_.find('.')) {
      const std::string_view head = rest_.substr(0, dot);
      toml::node* child = nullptr;
      if (toml::table* table = parent->as_table()) {
        child = table->get(head);
        // A section that the file does not have is made by
        // put(); whether it may be there, the keys decide.
        if (!child) return std::nullopt;
      } else {
        toml::array& entries = *parent->as_array();
        std::size_t index = entries.size();
        const auto [end, failed] = std::from_chars(head.begin(), head.end(), index);
        if (failed != std::errc{} || end != head.end()) index = entries.size();
        child = entries.get(index);
        if (!child) {
          return error(fmt::format("no entry {} here", head),
                       fmt::format("the scene has {}, counted from 0", entries.size()));
        }
      }
      if (!child->is_table() && !child->is_array())
        return error(fmt::format("{} is a value, not a section", head), "set it without a dot");
      parent = child;
      rest_ = rest_.substr(dot + 1);
    }
    return std::nullopt;
  }

  std::optional<Error> put(toml::table& parent, std::string_view value) {
    // Parsed under its own name, so that the new node knows where it came from.
    Result<toml::table> parsed = io::parse_toml(fmt::format("{} = {}", rest_, value), where_);
    if (!parsed && is_bare_word(value))
      parsed = io::parse_toml(fmt::format("{} = '{}'", rest_, value), where_);
    if (!parsed)
      return error("the value is not TOML", "write a number, true, false, \"text\" or [1, 2, 3]");
    std::ostringstream meaning;
    meaning << text_.substr(0, text_.find('=')) << '\n' << *parsed;
    meaning_ = meaning.str();
    // Moved, not parsed again: each node keeps the name of the override as its source.
    for (auto&& [key, node] : *parsed) {
      node.visit([&, &name = key](auto& concrete) {
        parent.insert_or_assign(name.str(), std::move(concrete));
      });
    }
    return std::nullopt;
  }

  std::string_view text_, rest_;
  std::string where_, meaning_;
};

}  // namespace

TextPosition SceneDocument::position_of(const toml::node& node) const {
  const toml::source_region& source = node.source();
  // An override has no line: its own text is its place.
  if (source.path && *source.path != path) return {.where = *source.path};
  return {.where = fmt::format("{}:{}", path, source.begin.line), .line = source.begin.line};
}

std::string path_beside(const std::string& document, const std::string& file) {
  std::error_code failed;
  const auto folder = std::filesystem::absolute(document, failed).parent_path();
  return (folder / file).lexically_normal().string();
}

Result<SceneDocument> load_scene_document(const std::string& path,
                                          const std::vector<std::string>& overrides) {
  const std::string ending = std::filesystem::path(path).extension().string();
  constexpr std::array<std::string_view, 8> kMeshes{".obj", ".stl", ".ply",  ".vtk",
                                                    ".vtp", ".off", ".gltf", ".glb"};
  if (std::ranges::find(kMeshes, ending) != kMeshes.end())
    return Error{fmt::format(
        "{}: is a mesh, no scene; make one of it: tact-lab new-scene {} --out mine.toml", path,
        path)};
  const Result<std::string> text = io::read_file(path, remedy(), kMaxFile_bytes);
  if (!text) return text.error();
  Result<toml::table> root = io::parse_toml(*text, path);
  if (!root) return root.error();
  TextHash hash;
  hash.add(*text);
  for (const std::string& one : overrides) {
    Override change(one);
    if (auto failed = change.lay_over(*root)) return *failed;
    // The meaning, so that law=auto and law="auto" are one run.
    hash.add(change.meaning());
  }
  return SceneDocument{.path = path, .root = std::move(*root), .hash = hash.hex()};
}

}  // namespace tact::model::reader
