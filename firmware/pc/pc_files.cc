// SPDX-License-Identifier: Apache-2.0
#include "firmware/pc/pc_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "model/io/input_file.h"

namespace tact::firmware::pc {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxCpus = 4096;  // bounds the result of a corrupt list; the kernel's limit is 8192

/// Parses the number at `at` and advances `at`. False: no number, or not one of a CPU.
bool parse_number(const char*& at, const char* end, int& number) {
  const auto [rest, error] = std::from_chars(at, end, number);
  at = rest;
  return error == std::errc{} && number >= 0 && number < kMaxCpus;
}

}  // namespace

std::optional<std::string> PcFiles::text(const std::string& path) const {
  auto all = model::io::read_file(root_ + path);
  if (!all || all->empty()) return std::nullopt;  // an empty file counts as unreadable
  return std::move(*all);
}

std::optional<std::string> PcFiles::line(const std::string& path) const {
  const auto all = text(path);
  if (!all) return std::nullopt;
  return all->substr(0, all->find('\n'));
}

std::vector<std::string> PcFiles::names(const std::string& folder) const {
  std::vector<std::string> found;
  std::error_code error;  // a process may end while its folder is read
  for (fs::directory_iterator i(root_ + folder, error), end; !error && i != end; i.increment(error))
    found.push_back(i->path().filename().string());
  // The kernel lists in any order; rows and their numbers must not depend on it.
  std::sort(found.begin(), found.end());
  return found;
}

bool PcFiles::is_there(const std::string& path) const {
  std::error_code error;
  return fs::exists(root_ + path, error);
}

bool PcFiles::is_writable(const std::string& path) const {
  return access((root_ + path).c_str(), W_OK) == 0;
}

std::vector<int> parse_cpu_list(const std::string& list) {
  std::vector<int> cpus;
  const char* at = list.data();
  const char* const end = at + list.size();
  while (at != end && *at != '\n') {
    int first = 0;
    if (!parse_number(at, end, first)) return {};
    int last = first;
    if (at != end && *at == '-') {
      ++at;
      if (!parse_number(at, end, last)) return {};
    }
    // At most kMaxCpus.
    for (int cpu = first; cpu <= last; ++cpu) cpus.push_back(cpu);
    if (at != end && *at == ',')
      ++at;
    else if (at != end && *at != '\n')
      return {};
  }
  return cpus;
}

std::string make_cpu_list(const std::vector<int>& cpus) {
  std::string out;
  for (std::size_t i = 0; i < cpus.size();) {
    std::size_t j = i;
    while (j + 1 < cpus.size() && cpus[j + 1] == cpus[j] + 1) ++j;
    out += fmt::format("{}{}", out.empty() ? "" : ",", cpus[i]);
    if (j > i) out += fmt::format("-{}", cpus[j]);
    i = j + 1;
  }
  return out;
}

bool is_realtime_kernel(const PcFiles& files) {
  const auto version = files.line("/proc/sys/kernel/version");
  // RT-1: the version first, because newer kernels lack the other file.
  if (version && version->find("PREEMPT_RT") != std::string::npos) return true;
  return files.line("/sys/kernel/realtime").value_or("0") == "1";
}

}  // namespace tact::firmware::pc
