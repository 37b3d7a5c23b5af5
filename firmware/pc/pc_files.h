// SPDX-License-Identifier: Apache-2.0
// pc_files.h - reads what the kernel reports in /proc, /sys and /dev, below any root folder.
//
// An empty root is this PC; tests and copies of another PC's files name a folder.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tact::firmware::pc {

class PcFiles {
 public:
  explicit PcFiles(std::string root = {}) : root_(std::move(root)) {}

  const std::string& root() const { return root_; }
  /// The whole file; nothing if it is empty or unreadable.
  std::optional<std::string> text(const std::string& path) const;
  /// Its first line without the line end; nothing if the file is empty or unreadable.
  std::optional<std::string> line(const std::string& path) const;
  /// Sorted names in a folder; empty if it is unreadable.
  std::vector<std::string> names(const std::string& folder) const;
  bool is_there(const std::string& path) const;
  bool is_writable(const std::string& path) const;

 private:
  std::string root_;
};

/// The kernel's list of CPUs, "0-2,5", in order; empty if the text is malformed.
std::vector<int> parse_cpu_list(const std::string& list);
/// The inverse, for a command: {0, 1, 2, 5} is "0-2,5".
std::string make_cpu_list(const std::vector<int>& cpus);

/// PREEMPT_RT by the kernel's version string, or by /sys/kernel/realtime of older ones.
bool is_realtime_kernel(const PcFiles& files);

}  // namespace tact::firmware::pc
