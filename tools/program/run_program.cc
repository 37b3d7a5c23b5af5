// SPDX-License-Identifier: Apache-2.0
#include "tools/program/run_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <thread>

#include "model/io/input_file.h"
#include "tools/program/child_groups.h"
#include "tools/program/interrupt.h"

namespace tact::tools::program {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;
using Clock = std::chrono::steady_clock;

constexpr int kLastLines = 12;
constexpr std::chrono::seconds kGrace{3};  // chosen: gmsh and ccx end at once

/// The char* array that exec wants, over strings that stay where they are.
std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  out.reserve(words.size() + 1);
  for (std::string& w : words) out.push_back(w.data());
  out.push_back(nullptr);
  return out;
}

/// Kills what is left of the group, and how its leader ended. Nothing if it cannot be known.
std::optional<int> end(pid_t child) {
  kill(-child, SIGKILL);
  forget_child_group(child);  // the number may belong to another from the next line on
  int status = 0;
  pid_t ended = -1;
  do ended = waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended != child) return std::nullopt;
  return status;
}

/// Still running? It stays a zombie, so that its number is not used again.
bool still_runs(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == 0;
}

/// The child, in the table of those to end; or a message about what kept it from starting.
Result<pid_t> start_child(const ProgramCall& call) {
  std::vector<std::string> words{call.program};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, call.log_path.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&files, call.directory.c_str());
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setpgroup(&how, 0);
  pid_t child = -1;
  int failed = 0;
  bool remembered = true;
  {
    StartOfChild start;
    posix_spawnattr_setsigmask(&how, &start.signals_before());
    failed =
        posix_spawnp(&child, call.program.c_str(), &files, &how, pointers(words).data(), environ);
    if (failed == 0) remembered = start.remember(child);
  }
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  if (!remembered) {
    static_cast<void>(end(child));
    return Error{
        fmt::format("{} is one program too many at a time; use fewer --jobs", call.program)};
  }
  if (failed == 0) return child;
  const bool has_folder = fs::is_directory(call.directory);
  if (failed == ENOENT && has_folder)
    return Error{fmt::format("{} is not installed; apt install {}", call.program, call.package)};
  return Error{fmt::format("{} does not start in {}: {}", call.program, call.directory,
                           has_folder ? std::strerror(failed) : "no such folder")};
}

/// Hands on the lines that a program has printed since the last call.
class LineReader {
 public:
  LineReader(const std::string& path, const std::function<void(std::string_view)>& on_line)
      : on_line_(on_line), fd_(on_line ? open(path.c_str(), O_RDONLY | O_CLOEXEC) : -1) {}
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  ~LineReader() {
    if (fd_ >= 0) close(fd_);
  }

  void hand_on() {
    std::array<char, 4096> part{};
    for (ssize_t n = 0; fd_ >= 0 && (n = read(fd_, part.data(), part.size())) > 0;) {
      rest_.append(part.data(), static_cast<std::size_t>(n));
      for (std::size_t end = 0; (end = rest_.find('\n')) != std::string::npos;) {
        on_line_(std::string_view(rest_).substr(0, end));
        rest_.erase(0, end + 1);
      }
    }
  }

 private:
  const std::function<void(std::string_view)>& on_line_;
  int fd_ = -1;
  std::string rest_;
};

std::string tail(const std::string& text) {
  std::size_t at = text.size();
  for (int line = 0; line <= kLastLines && at != std::string::npos && at > 0; ++line)
    at = text.rfind('\n', at - 1);
  return at == std::string::npos ? text : text.substr(at);
}

/// Asks the group to end, as its leader may have programs and files of its own; then kills what is
/// left of it.
std::optional<int> stop(pid_t child) {
  kill(-child, SIGTERM);
  for (const auto begun = Clock::now(); still_runs(child) && Clock::now() - begun < kGrace;)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return end(child);
}

}  // namespace

Result<std::string> run_program(const ProgramCall& call) {
  using namespace std::chrono_literals;
  const auto begun = Clock::now();
  const auto child = start_child(call);
  if (!child) return child.error();
  LineReader lines(call.log_path, call.on_line);
  while (still_runs(*child)) {
    lines.hand_on();
    if (is_interrupted()) {
      static_cast<void>(stop(*child));
      return interruption();
    }
    if (call.time_limit_s > 0.0 &&
        Clock::now() - begun > std::chrono::duration<double>(call.time_limit_s)) {
      static_cast<void>(stop(*child));
      return Error{fmt::format("{} took longer than {:g} s and was ended; what it printed is in {}",
                               call.program, call.time_limit_s, call.log_path)};
    }
    std::this_thread::sleep_for(10ms);
  }
  const auto status = end(*child);
  lines.hand_on();
  if (is_interrupted()) return interruption();
  if (!status)
    return Error{fmt::format(
        "how {} ended cannot be known, since SIGCHLD is ignored; start from a plain shell",
        call.program)};
  auto text = model::io::read_file(call.log_path);
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) return text;
  const std::string how = WIFEXITED(*status) ? fmt::format("status {}", WEXITSTATUS(*status))
                                             : fmt::format("signal {}", WTERMSIG(*status));
  return Error{fmt::format("{} ended with {}; all it printed is in {}, at the end:{}", call.program,
                           how, call.log_path, tail(text ? *text : "")),
               WIFEXITED(*status) ? model::ErrorCode::kOther : model::ErrorCode::kProgramCrashed};
}

Result<RunningProgram> RunningProgram::start(const ProgramCall& call) {
  const auto child = start_child(call);
  if (!child) return child.error();
  return RunningProgram(*child);
}

RunningProgram::~RunningProgram() {
  if (child_ > 0) static_cast<void>(end(child_));
}

bool RunningProgram::is_running() const { return child_ > 0 && still_runs(child_); }

Error interruption() { return Error{"interrupted", model::ErrorCode::kInterrupted}; }

Result<ScratchFolder> ScratchFolder::make(const std::string& name) {
  std::error_code failed;
  const fs::path base = fs::temp_directory_path(failed);
  std::string path = (base / (name + "-XXXXXX")).string();
  if (failed || mkdtemp(path.data()) == nullptr) {
    return Error{
        fmt::format("no folder {} can be made; check that TMPDIR exists and has room", path)};
  }
  remember_scratch(path);
  return ScratchFolder(path);
}

ScratchFolder::~ScratchFolder() {
  if (path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  forget_scratch(path_);
}

}  // namespace tact::tools::program
