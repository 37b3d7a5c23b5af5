// SPDX-License-Identifier: Apache-2.0
#include "firmware/guardian/guardian.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "firmware/guardian/orders.h"

namespace tact::firmware::guardian {
namespace {

// Chosen: start-up allows for a busy PC; at the end the guardian has nothing left to do.
constexpr int kReadyWait_ms = 3000, kEndWait_ms = 100;

// Both programs are installed together; orders.h refuses a guardian of another build.
std::string beside_this_program() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / kProgram;
}

model::Error refused(const std::string& program, const std::string& why) {
  return model::Error{
      fmt::format("{} cannot be started ({}), and nothing would zero the device if this program "
                  "died: build or install it again, both together",
                  program, why)};
}

sigset_t all_signals() {
  sigset_t all{};
  sigfillset(&all);
  return all;
}

/// 0: SCHED_OTHER. Without the permission the thread stays SCHED_OTHER and reacts later;
/// pc/rt_setup.h has reported that.
void become_fifo(int priority) {
  const sched_param wanted{.sched_priority = priority};
  pthread_setschedparam(pthread_self(), priority > 0 ? SCHED_FIFO : SCHED_OTHER, &wanted);
}

/// The guardian has ended, or something is readable: both are treated alike here.
bool is_hung_up(const pollfd& file) { return (file.revents & (POLLHUP | POLLERR | POLLIN)) != 0; }

}  // namespace

model::Result<std::unique_ptr<Guardian>> Guardian::start(const hal::ShutdownFrames& frames,
                                                         const GuardianSettings& settings) {
  const std::string program = settings.program.empty() ? beside_this_program() : settings.program;
  auto liveness = LivenessLock::make();
  if (!liveness) return liveness.error();
  std::unique_ptr<Guardian> guardian(new Guardian(std::move(*liveness)));
  // A core dump would hold all threads until it is written, 0.1 s and more. 1 byte: neither a file
  // nor a pipe (core(5)).
  rlimit core{};
  getrlimit(RLIMIT_CORE, &core);
  core.rlim_cur = std::min<rlim_t>(core.rlim_max, 1);
  setrlimit(RLIMIT_CORE, &core);
  if (const auto why = guardian->spawn(program)) return refused(program, std::strerror(*why));
  auto thread = hal::threads::start_thread(
      "tact-guard", [self = guardian.get(), settings] { self->keep(settings.priority); });
  if (!thread) return thread.error();
  guardian->thread_ = std::move(*thread);
  // The lock must be held before the guardian receives it: the guardian takes a free lock for a
  // regular end.
  guardian->held_.acquire();
  // getpid() appears only in a message; no signal is sent to that number.
  const Orders orders{.frames = frames,
                      .priority = settings.priority,
                      .process = getpid(),
                      .silence_ns = settings.silence_ns,
                      .period_ns = settings.period_ns};
  if (!give_orders(guardian->socket_, orders, guardian->liveness_.descriptor()))
    return refused(program, std::strerror(errno));
  if (!guardian->is_ready()) return refused(program, "it does not answer");
  return guardian;
}

/// In a new session and with all signals blocked, so that a terminal's signals reach only tactd.
/// Returns the errno of a failure.
std::optional<int> Guardian::spawn(const std::string& program) {
  std::array<int, 2> ends{};
  dismiss_ = eventfd(0, EFD_CLOEXEC);
  if (dismiss_ < 0 || socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return errno;
  socket_ = ends[0];
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  // The copy by dup2 stays open in the new program; all other descriptors are close-on-exec.
  posix_spawn_file_actions_adddup2(&files, ends[1], kOrdersFd);
  // Otherwise the guardian would keep a pipe of tactd's standard output open.
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const sigset_t all = all_signals();
  posix_spawnattr_setsigmask(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  std::string name = kProgram;
  const std::array<char*, 2> words{name.data(), nullptr};
  const int error =
      posix_spawn(&process_, program.c_str(), &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(ends[1]);
  if (error == 0) return std::nullopt;
  process_ = -1;
  return error;
}

bool Guardian::is_ready() const {
  pollfd one{.fd = socket_, .events = POLLIN, .revents = 0};
  char answer = 0;
  return poll(&one, 1, kReadyWait_ms) == 1 && recv(socket_, &answer, 1, MSG_DONTWAIT) == 1;
}

/// After its ready byte the guardian sends nothing, so any event on the socket is its end. The
/// thread is SCHED_FIFO, because a killed thread must be scheduled before the kernel releases its
/// lock.
void Guardian::keep(int priority) {
  liveness_.hold();
  held_.release();
  become_fifo(priority);
  std::array<pollfd, 2> either{{{.fd = dismiss_, .events = POLLIN, .revents = 0},
                                {.fd = socket_, .events = POLLHUP, .revents = 0}}};
  while (!is_hung_up(either[0])) {
    if (poll(either.data(), either.size(), -1) < 0) continue;
    if (!is_hung_up(either[1])) continue;
    lost_.store(true);
    either[1].fd = -1;  // poll ignores it from here on
    either[1].revents = 0;
  }
  liveness_.let_go();
  // A thread that frees its memory at FIFO priority delays all others (pc/rt_setup.h).
  become_fifo(0);
}

Guardian::~Guardian() {
  // In this order: the lock is released, the guardian ends by itself, and is killed only if it does
  // not. In both cases it has sent nothing.
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    static_cast<void>(::write(dismiss_, &one, sizeof one));
    thread_.join();
  }
  pollfd end{.fd = socket_, .events = POLLHUP, .revents = 0};
  if (process_ > 0 && poll(&end, 1, kEndWait_ms) == 0) kill(process_, SIGKILL);
  // Otherwise it would stay as a zombie for tactd's lifetime.
  if (process_ > 0) waitpid(process_, nullptr, 0);
  for (const int fd : {socket_, dismiss_})
    if (fd >= 0) close(fd);
}

}  // namespace tact::firmware::guardian
