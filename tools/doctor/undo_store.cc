// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/undo_store.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/io/json.h"

namespace tact::tools::doctor {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;
using nlohmann::json;

// As /etc has its drop-ins: read by all, written by root.
constexpr mode_t kDropInMode = 0644;

/// Whole, whatever stood there: it is kept.
std::optional<Error> replace(const std::string& path, const std::string& content, mode_t mode) {
  std::error_code wrong;
  if (model::io::check_target(path, content)) fs::remove(path, wrong);
  if (auto failed = model::io::write_file(path, content)) return failed;
  if (chmod(path.c_str(), mode) == 0) return std::nullopt;
  return Error{path + ": its permissions cannot be set"};
}

std::vector<std::string> words_of(const json& list) {
  std::vector<std::string> words;
  for (const json& word : list)
    if (const auto* text = word.get_ptr<const std::string*>()) words.push_back(*text);
  return words;
}

/// A member of an object; null where there is none.
const json& member(const json& object, const char* name) {
  static const json none;
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? none : *found;
}

unsigned number_of(const json& object, const char* name) {
  const json& number = member(object, name);
  return number.is_number_unsigned() ? number.get<unsigned>() : 0;
}

std::string text_of(const json& object, const char* name) {
  const auto* text = member(object, name).get_ptr<const std::string*>();
  return text == nullptr ? "" : *text;
}

}  // namespace

Result<UndoStore> UndoStore::open(const std::string& root) {
  UndoStore store(root);
  const std::string folder = root + kUndoFolder;
  struct stat info{};
  if (lstat(folder.c_str(), &info) != 0) return store;
  // What stands here is written as root by --undo: a folder that others write would make them root.
  const bool is_ours = S_ISDIR(info.st_mode) && (info.st_uid == 0 || info.st_uid == geteuid()) &&
                       (info.st_mode & 022) == 0;
  if (!is_ours)
    return Error{folder +
                 ": others may write there, so it is not believed; look into it, and "
                 "remove it"};
  if (auto failed = store.load()) return std::move(*failed);
  return store;
}

std::string UndoStore::copy_of(const KeptFile& kept) const {
  return fmt::format("{}{}/{}", root_, kUndoFolder, kept.copy);
}

// An error: its copy is gone.
Result<bool> UndoStore::is_edited(const KeptFile& kept) const {
  const auto now = model::io::read_file(root_ + kept.path);
  // Gone is no edit: what was there can be put back.
  if (!now || *now == kept.written) return false;
  if (!kept.existed) return true;
  const auto before = model::io::read_file(copy_of(kept));
  if (!before) return before.error();
  return *now != *before;
}

std::optional<Error> UndoStore::load() {
  const std::string path = root_ + kUndoFolder + "/undo.json";
  struct stat info{};
  if (lstat(path.c_str(), &info) != 0) {
    // Nothing was ever fixed.
    if (errno == ENOENT) return std::nullopt;
    return Error{path + ": only root can read what --fix kept; use sudo"};
  }
  const auto read = model::io::read_json(path, "put the files of its list back by hand");
  if (!read) return read.error();
  for (const json& file : member(*read, "files")) {
    files_.push_back({.path = text_of(file, "path"),
                      .written = text_of(file, "written"),
                      .copy = number_of(file, "copy"),
                      .existed = member(file, "mode").is_number_unsigned(),
                      .mode = number_of(file, "mode"),
                      .user = number_of(file, "user"),
                      .group = number_of(file, "group"),
                      .made = words_of(member(file, "made"))});
  }
  for (const json& command : member(*read, "commands"))
    commands_.push_back({.file = "",
                         .words = words_of(member(command, "words")),
                         .back = words_of(member(command, "back")),
                         .back_last = member(command, "back_last") == true});
  return std::nullopt;
}

std::optional<Error> UndoStore::save() const {
  json files = json::array(), commands = json::array();
  for (const KeptFile& file : files_)
    files.push_back({{"path", file.path},
                     {"written", file.written},
                     {"copy", file.copy},
                     {"user", file.user},
                     {"group", file.group},
                     {"mode", file.existed ? json(file.mode) : json()},
                     {"made", file.made}});
  for (const FixCommand& command : commands_)
    commands.push_back(
        {{"words", command.words}, {"back", command.back}, {"back_last", command.back_last}});
  std::error_code wrong;
  fs::create_directories(root_ + kUndoFolder, wrong);
  fs::permissions(root_ + kUndoFolder, fs::perms(0700), wrong);
  return model::io::write_file(
      root_ + kUndoFolder + "/undo.json",
      model::io::text_of(json{{"files", files}, {"commands", commands}}, 2) + "\n");
}

std::optional<Error> UndoStore::keep(const DropIn& file) {
  const std::string path = root_ + file.path;
  struct stat info{};
  KeptFile kept{.path = file.path, .written = file.content, .made = {}};
  for (const KeptFile& other : files_) kept.copy = std::max(kept.copy, other.copy + 1);
  if (lstat(path.c_str(), &info) == 0) {
    // A link could point anywhere: following it as root would write there.
    if (!S_ISREG(info.st_mode)) return Error{path + ": is no plain file; move it away first"};
    kept.existed = true;
    kept.mode = info.st_mode & 07777;
    kept.user = info.st_uid;
    kept.group = info.st_gid;
    const auto content = model::io::read_file(path);
    if (!content) return content.error();
    std::error_code wrong;
    fs::create_directories(root_ + kUndoFolder, wrong);
    fs::permissions(root_ + kUndoFolder, fs::perms(0700), wrong);
    if (auto failed = replace(copy_of(kept), *content, 0600)) return failed;
  }
  std::error_code unseen;
  // Folders that are made now go again with the last file in them.
  for (fs::path folder = fs::path(path).parent_path(); !fs::exists(folder, unseen);
       folder = folder.parent_path())
    kept.made.push_back(folder.string().substr(root_.size()));
  files_.push_back(std::move(kept));
  return std::nullopt;
}

std::optional<Error> UndoStore::write(const DropIn& file) {
  const auto known = std::ranges::find(files_, file.path, &KeptFile::path);
  if (known == files_.end()) {
    if (auto failed = keep(file)) return failed;
  } else {
    const auto edited = is_edited(*known);
    if (!edited) return edited.error();
    if (*edited)
      return Error{root_ + file.path + ": was edited after --fix; move it away, then fix again"};
    known->written = file.content;
  }
  if (auto failed = save()) return failed;
  std::error_code wrong;
  // Only after the list is on disk: a crash in between leaves an undo that knows of the file.
  fs::create_directories(fs::path(root_ + file.path).parent_path(), wrong);
  return replace(root_ + file.path, file.content, kDropInMode);
}

std::optional<Error> UndoStore::note(const FixCommand& command) {
  const bool is_known = std::ranges::any_of(
      commands_, [&](const FixCommand& one) { return one.words == command.words; });
  if (is_known) return std::nullopt;
  commands_.push_back(command);
  return save();
}

std::optional<Error> UndoStore::restore(const KeptFile& kept) const {
  const std::string path = root_ + kept.path;
  std::error_code wrong;
  if (kept.existed) {
    const auto before = model::io::read_file(copy_of(kept));
    if (!before) return before.error();
    if (auto failed = replace(path, *before, kept.mode)) return failed;
    if (chown(path.c_str(), kept.user, kept.group) == 0 && chmod(path.c_str(), kept.mode) == 0)
      return std::nullopt;
    return Error{path + ": its owner cannot be set"};
  }
  fs::remove(path, wrong);
  if (wrong) return Error{path + ": cannot be removed: " + wrong.message()};
  for (const std::string& folder : kept.made) fs::remove(root_ + folder, wrong);  // if empty
  return std::nullopt;
}

Result<bool> UndoStore::put_back(std::size_t index) {
  const auto edited = is_edited(files_[index]);
  if (!edited) return edited.error();
  if (*edited) return false;
  if (auto failed = restore(files_[index])) return std::move(*failed);
  files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(index));
  if (auto failed = save()) return std::move(*failed);
  return true;
}

std::optional<Error> UndoStore::forget(const FixCommand& command) {
  std::erase_if(commands_, [&](const FixCommand& one) { return one.words == command.words; });
  return save();
}

void UndoStore::forget() {
  std::error_code wrong;
  fs::remove_all(root_ + kUndoFolder, wrong);
  files_.clear();
  commands_.clear();
}

}  // namespace tact::tools::doctor
