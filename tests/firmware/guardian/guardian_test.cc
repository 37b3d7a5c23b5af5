// SPDX-License-Identifier: Apache-2.0
// The real tact-guardian beside a program that is killed, and one that leaves.
#include "firmware/guardian/guardian.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <functional>
#include <string_view>
#include <utility>

#include "tests/support/program.h"

namespace tact::firmware::guardian::guardian_test {

constexpr int kTimeout_ms = 20'000, kSilence_ms = 100;
constexpr hal::ShutdownFrames::Bytes kFirst{1}, kSecond{2}, kThird{3};

/// Both ends of a device whose messages are datagrams; three frames in two steps.
struct Wire {
  Wire() {
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, end) != 0) std::abort();
    frames.fd = end[0];
    frames.add_step(std::array{kFirst, kSecond});
    frames.add_step(std::array<hal::ShutdownFrames::Bytes, 1>{kThird});
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire() {
    for (const int fd : end) close(fd);
  }
  std::vector<hal::ShutdownFrames::Bytes> hear(std::size_t most, int timeout_ms) const {
    std::vector<hal::ShutdownFrames::Bytes> heard;
    pollfd one{.fd = end[1], .events = POLLIN, .revents = 0};
    while (heard.size() < most && poll(&one, 1, timeout_ms) == 1) {
      heard.emplace_back();
      if (recv(end[1], heard.back().data(), heard.back().size(), 0) != 16) heard.pop_back();
    }
    return heard;
  }
  hal::ShutdownFrames frames;
  int end[2] = {-1, -1};
};

std::unique_ptr<Guardian> start(const hal::ShutdownFrames& frames) {
  auto guardian = Guardian::start(
      frames,
      {.priority = 1, .silence_ns = 20'000'000, .program = tests::program_path("tact-guardian")});
  EXPECT_TRUE(guardian) << guardian.error().message;
  return guardian ? std::move(*guardian) : nullptr;
}

/// A program with a guardian, which does this when it has one; its pid, and its guardian's.
struct Guarded {
  Guarded(const Wire& wire, const std::function<void(Guardian&)>& then) {
    int pipe_ends[2] = {-1, -1};
    if (pipe(pipe_ends) != 0) std::abort();
    program = fork();
    if (program == 0) {
      const auto own = start(wire.frames);
      const pid_t pid = own ? own->process() : -1;
      if (write(pipe_ends[1], &pid, sizeof pid) != sizeof pid || pid < 0) _exit(9);
      then(*own);
      pause();
    }
    close(pipe_ends[1]);
    EXPECT_EQ(read(pipe_ends[0], &guardian, sizeof guardian),
              static_cast<ssize_t>(sizeof guardian));
    close(pipe_ends[0]);
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() { end(); }
  void end() {
    if (program <= 0) return;
    kill(program, SIGKILL);
    waitpid(program, nullptr, 0);
    program = -1;
  }
  pid_t program = -1, guardian = -1;
};

bool soon(const std::function<bool()>& what) {
  for (int i = 0; i < kTimeout_ms && !what(); ++i) usleep(1000);
  return what();
}

bool lives(pid_t process) { return kill(process, 0) == 0; }

using Words = std::vector<hal::ShutdownFrames::Bytes>;
const Words kAll{kFirst, kSecond, kThird};

TEST(Guardian, SendsFramesWhenTactdIsKilled) {
  const Wire wire;
  Guarded guarded(wire, [](Guardian&) {});
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{}) << "as long as it lives";
  guarded.end();
  EXPECT_EQ(wire.hear(3, kTimeout_ms), kAll);
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{}) << "once";
}

TEST(Guardian, SendsFramesWhenTactdCrashesOrExits) {
  const Wire crashed, left;
  const Guarded one(crashed, [](Guardian&) { std::raise(SIGKILL); });
  EXPECT_EQ(crashed.hear(3, kTimeout_ms), kAll);
  const Guarded other(left, [](Guardian&) { _exit(0); });
  EXPECT_EQ(left.hear(3, kTimeout_ms), kAll);
}

/// Counts every millisecond, as the watch does.
void count(Guardian& guardian) {
  for (;;) {
    guardian.page().holder_count.fetch_add(1);
    usleep(1000);
  }
}

TEST(Guardian, SendsFramesWhenTactdIsStopped) {
  const Wire wire;
  const Guarded guarded(wire, count);
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{}) << "as long as it counts";
  kill(guarded.program, SIGSTOP);
  EXPECT_EQ(wire.hear(3, kTimeout_ms), kAll);
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{}) << "once";
}

TEST(Guardian, SaysNothingWithoutAWatchedProgram) {
  const Wire wire;
  const Guarded guarded(wire, [](Guardian& guardian) {
    guardian.page().holder_count.store(7);
    guardian.page().holder_count.store(0);
  });
  kill(guarded.program, SIGSTOP);
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{});
}

TEST(Guardian, ACrashLeavesNoCoreToWaitFor) {
  const Wire wire;
  const Guarded guarded(wire, [](Guardian&) {});
  EXPECT_EQ(tests::run_command("grep -c 'Max core file size *1 ' /proc/" +
                               std::to_string(guarded.program) + "/limits")
                .output,
            "1\n");
}

TEST(Guardian, CounterRunsUntilTheGuardianIsStopped) {
  const Wire wire;
  const auto guardian = start(wire.frames);
  ASSERT_TRUE(guardian);
  const auto& its_count = guardian->page().waiter_count;
  EXPECT_TRUE(soon([&] { return its_count.load() > 3; }));
  kill(guardian->process(), SIGSTOP);
  std::uint64_t before = 0;
  EXPECT_TRUE(soon([&] {
    usleep(kSilence_ms * 1000);
    return std::exchange(before, its_count.load()) == its_count.load();
  }));
  kill(guardian->process(), SIGCONT);
}

TEST(Guardian, ReportsThatTheDeviceTookNothing) {
  Wire wire;
  close(wire.end[1]);  // no reader at the other end
  wire.end[1] = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int own = dup(STDERR_FILENO), reported = memfd_create("log", MFD_CLOEXEC);
  dup2(reported, STDERR_FILENO);
  Guarded guarded(wire, [](Guardian&) {});
  dup2(own, STDERR_FILENO);
  close(own);
  guarded.end();
  std::array<char, 300> text{};
  EXPECT_TRUE(soon([&] { return pread(reported, text.data(), text.size() - 1, 0) > 0; }));
  EXPECT_NE(std::string_view(text.data()).find("did not take zero force"), std::string_view::npos)
      << text.data();
  close(reported);
}

TEST(Guardian, SaysNothingWhenItIsLetGoAndIsGoneThen) {
  const Wire wire;
  auto guardian = start(wire.frames);
  ASSERT_TRUE(guardian);
  const pid_t process = guardian->process();
  EXPECT_TRUE(lives(process));
  guardian.reset();
  EXPECT_FALSE(lives(process));
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{});
}

TEST(Guardian, ItsOwnDeathIsNoticed) {
  const Wire wire;
  auto guardian = start(wire.frames);
  ASSERT_TRUE(guardian);
  EXPECT_FALSE(guardian->is_lost().load());
  kill(guardian->process(), SIGKILL);
  EXPECT_TRUE(soon([&] { return guardian->is_lost().load(); }));
  guardian.reset();
  EXPECT_EQ(wire.hear(1, kSilence_ms), Words{});
}

TEST(Guardian, NoSignalOfATerminalReachesIt) {
  const Wire wire;
  Guarded guarded(wire, [](Guardian&) {});
  EXPECT_EQ(getsid(guarded.guardian), guarded.guardian) << "no terminal of ours is its own";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGPIPE, SIGUSR1, SIGALRM})
    kill(guarded.guardian, signal);
  usleep(20'000);
  guarded.end();
  EXPECT_EQ(wire.hear(3, kTimeout_ms), kAll);
}

TEST(Guardian, ItsCallsAreFilteredAndItsFilesAreFew) {
  const Wire wire;
  const auto guardian = start(wire.frames);
  ASSERT_TRUE(guardian);
  const std::string proc = "/proc/" + std::to_string(guardian->process());
  EXPECT_EQ(tests::run_command("grep -c 'Seccomp:.2' " + proc + "/status").output, "1\n");
  EXPECT_EQ(tests::run_command("ls " + proc + "/fd | wc -l").output, "5\n")
      << "socket, /dev/null, standard error, liveness lock, device";
}

TEST(Guardian, IsRealTimeInLockedMemoryAndSparedByTheOomKiller) {
  if (geteuid() != 0) GTEST_SKIP() << "an ordinary user may not ask for all of it";
  const Wire wire;
  const auto guardian = start(wire.frames);
  ASSERT_TRUE(guardian);
  const std::string proc = "/proc/" + std::to_string(guardian->process());
  EXPECT_EQ(sched_getscheduler(guardian->process()), SCHED_FIFO);
  // A container may have kept this from root.
  if (tests::run_command("echo -1000 >/proc/self/oom_score_adj").status == 0)
    EXPECT_EQ(tests::run_command("cat " + proc + "/oom_score_adj").output, "-1000\n");
  const auto field = [&proc](const std::string& name) {
    return std::stol(
        tests::run_command("awk '/^" + name + ":/ {print $2}' " + proc + "/status").output);
  };
  EXPECT_GE(2 * field("VmLck"), field("VmSize")) << "the kernel's own pages are no part of it";
}

TEST(Guardian, AMissingProgramIsRefusedWithTheRemedy) {
  const Wire wire;
  const auto guardian =
      Guardian::start(wire.frames, {.priority = 1, .program = "/nowhere/tact-guardian"});
  ASSERT_FALSE(guardian);
  EXPECT_NE(guardian.error().message.find("cannot be started (No such file or directory)"),
            std::string::npos)
      << guardian.error().message;
}

TEST(Guardian, StartFromATerminalIsRefused) {
  const tests::Outcome outcome = tests::run_program("tact-guardian", "</dev/null");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("tactd starts this program"), std::string::npos) << outcome.output;
}

}  // namespace tact::firmware::guardian::guardian_test
