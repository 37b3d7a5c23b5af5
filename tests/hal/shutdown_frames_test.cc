// SPDX-License-Identifier: Apache-2.0
#include "hal/shutdown_frames.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <iterator>
#include <thread>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::shutdown_frames_test {

using Bytes = ShutdownFrames::Bytes;

struct Ends {
  Ends() {
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, fd) != 0) std::abort();
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;
  ~Ends() {
    close(fd[0]);
    close(fd[1]);
  }
  std::vector<Bytes> heard() const {
    std::vector<Bytes> all;
    for (Bytes one{}; recv(fd[1], one.data(), one.size(), MSG_DONTWAIT) == 16;) all.push_back(one);
    return all;
  }
  int fd[2] = {-1, -1};
};

ShutdownFrames three_frames(int fd) {
  ShutdownFrames frames{.fd = fd};
  EXPECT_TRUE(frames.add_step(std::array{Bytes{1}, Bytes{2}}));
  EXPECT_TRUE(frames.add_step(std::array<Bytes, 1>{Bytes{3}}));
  return frames;
}

TEST(ShutdownFrames, AStepLeavesAloneAndAllLeaveInOrderWithoutHeap) {
  const Ends ends;
  const ShutdownFrames frames = three_frames(ends.fd[0]);
  const tests::NoAlloc guard;
  EXPECT_EQ(send_step(frames, 0), 0);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(ends.heard(), (std::vector<Bytes>{{1}, {2}}));
  EXPECT_EQ(send_all(frames), 0);
  EXPECT_EQ(ends.heard(), (std::vector<Bytes>{{1}, {2}, {3}}));
  EXPECT_EQ(send_step(frames, 7), 0) << "nothing to send";
}

TEST(ShutdownFrames, CanFdFrameIsSentWholeBesideClassicFrames) {
  const Ends ends;
  ShutdownFrames frames{.fd = ends.fd[0]};
  ShutdownFrames::LongBytes one{};
  one.front() = 7, one.back() = 9;
  EXPECT_TRUE(frames.add_step(std::array<ShutdownFrames::LongBytes, 1>{one}));
  EXPECT_TRUE(frames.add_step(std::array<Bytes, 1>{Bytes{1}}));
  EXPECT_EQ(send_all(frames), 0);
  ShutdownFrames::LongBytes heard{};
  ASSERT_EQ(recv(ends.fd[1], heard.data(), heard.size(), MSG_DONTWAIT), 72);
  EXPECT_EQ(heard, one);
  EXPECT_EQ(ends.heard(), (std::vector<Bytes>{{1}}));
}

TEST(ShutdownFrames, FramesBeyondTheMaximumAreRefused) {
  ShutdownFrames frames;
  const std::vector<Bytes> many(ShutdownFrames::kMax);
  EXPECT_TRUE(frames.add_step(many));
  EXPECT_FALSE(frames.add_step(std::array<Bytes, 1>{}));
  EXPECT_EQ(frames.count, ShutdownFrames::kMax);
}

TEST(ShutdownFrames, AQueueThatIsFullForAMomentIsTriedAgain) {
  const Ends ends;
  const ShutdownFrames frames = three_frames(ends.fd[0]);
  const Bytes other{9};
  while (send(ends.fd[0], other.data(), other.size(), MSG_DONTWAIT) == 16) {
  }
  EXPECT_NE(send_step(frames, 0), 0);
  std::thread reader([&] { ends.heard(); });
  for (int i = 0; i < 1000 && send_all(frames) != 0; ++i) {
  }
  reader.join();
  EXPECT_EQ(send_step(frames, 0), 0);
}

// The kernel refuses the first step, of two frames, and takes the second.
TEST(ShutdownFrames, AStepThatFailsKeepsNoLaterOneBack) {
  const auto send_without_the_first = [] {
    const Ends ends;
    const ShutdownFrames frames = three_frames(ends.fd[0]);
    sock_filter rules[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_sendmmsg, 0, 2),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 2, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EIO),
    };
    const sock_fprog program{.len = std::size(rules), .filter = rules};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) _exit(1);
    if (send_all(frames) != EIO) _exit(2);
    _exit(ends.heard() == std::vector<Bytes>{{3}} ? 0 : 3);
  };
  EXPECT_EXIT(send_without_the_first(), testing::ExitedWithCode(0), "");
}

TEST(ShutdownFrames, ADeviceThatIsGoneIsAnErrorAndNoMore) {
  Ends ends;
  ShutdownFrames frames = three_frames(ends.fd[0]);
  close(ends.fd[1]);
  ends.fd[1] = -1;
  EXPECT_NE(send_all(frames), 0);
  frames.carrier = ShutdownFrames::Carrier::kUsbBulk;
  EXPECT_EQ(send_all(frames), ENOTTY) << "no USB device at all";
}

}  // namespace tact::hal::shutdown_frames_test
