// SPDX-License-Identifier: Apache-2.0
// undo_store.h - what stood where --fix wrote, kept so that --undo puts it back byte for byte.
//
// A folder of root's alone, not that of the service's user, /var/lib/tact: whoever can write there
// says what --undo writes as root. undo.json lists the files and commands that are not taken back;
// a file N beside it is what stood at the place of the one whose copy is N before the first --fix.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/doctor/fix_plan.h"

namespace tact::tools::doctor {

inline constexpr const char* kUndoFolder = "/var/lib/tact-doctor";

/// One file of --fix.
struct KeptFile {
  std::string path;
  std::string written;  // by --fix, the last time
  unsigned copy = 0;    // number of the file that has what existed
  bool existed = false;
  unsigned mode = 0, user = 0, group = 0;  // of what existed
  std::vector<std::string> made;           // folders that were not there, the deepest first
};

class UndoStore {
 public:
  /// Below `root`, the empty text for this PC. An error where others may write to it.
  static model::Result<UndoStore> open(const std::string& root);

  const std::vector<KeptFile>& files() const { return files_; }
  const std::vector<FixCommand>& commands() const { return commands_; }
  bool is_empty() const { return files_.empty() && commands_.empty(); }

  /// Writes a file whole, after what stands there is kept; what a first --fix kept stays. An error
  /// where somebody has edited it since.
  std::optional<model::Error> write(const DropIn& file);
  /// A command has been run.
  std::optional<model::Error> note(const FixCommand& command);
  /// Puts file `index` back, and off the list. False: somebody has edited it since, so it stays.
  model::Result<bool> put_back(std::size_t index);
  /// A command has been taken back.
  std::optional<model::Error> forget(const FixCommand& command);
  /// Once all is back.
  void forget();

 private:
  explicit UndoStore(std::string root) : root_(std::move(root)) {}
  std::string copy_of(const KeptFile& kept) const;
  model::Result<bool> is_edited(const KeptFile& kept) const;
  std::optional<model::Error> restore(const KeptFile& kept) const;
  std::optional<model::Error> keep(const DropIn& file);
  std::optional<model::Error> save() const;
  std::optional<model::Error> load();

  std::string root_;
  std::vector<KeptFile> files_;
  std::vector<FixCommand> commands_;
};

}  // namespace tact::tools::doctor
