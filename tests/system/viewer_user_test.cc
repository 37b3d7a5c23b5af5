// SPDX-License-Identifier: Apache-2.0
// A viewer that runs as another user than tactd: it looks, and it cannot command.
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "firmware/console/control_name.h"
#include "model/io/socket_file.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::viewer_user_test {

// Three users and a group of every Debian, in the parts of tact, tact-view, a stranger and haptics.
constexpr const char* kWords =
    "as_tactd='setpriv --reuid=daemon --regid=games --clear-groups'\n"
    "as_viewer='setpriv --reuid=nobody --regid=nogroup --groups=games'\n"
    "as_stranger='setpriv --reuid=man --regid=man --clear-groups'\n"
    "ready() { for i in {1..200}; do grep -qs 'ready, force is off' log && break; sleep .05; "
    "done; }\n"
    // look NAME USER OPTIONS: how many frames the viewer got
    "look() { local name=$1 user=$2; shift 2; rm -f seen/r; timeout -s INT 1.5 $user $view --port "
    "0 --json --page page --record seen/r \"$@\" >$name.said 2>&1; echo \"$name saw $($view --open "
    "seen/r --export r.csv --json 2>&1 | grep -o '\"frames\":[0-9]*')\"; }\n"
    // A busy PC may take longer to start a viewer than it looks.
    "look_until_seen() { local i; for i in 1 2 3 4 5; do look \"$@\" >saw; grep -qs ':[1-9]' saw "
    "&& "
    "break; done; cat saw; }\n";

class ViewerUser : public Tactd {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "only root becomes another user";
    Tactd::SetUp();
    if (run_command("setpriv --reuid=daemon --regid=games --clear-groups test -x " +
                    program_path("tactd"))
            .status != 0)
      GTEST_SKIP() << "other users cannot reach the build folder";
    std::filesystem::permissions(folder, std::filesystem::perms(0755));
  }
  /// Bash beside a tactd of the user daemon that drives a stand-in for hardware, disarmed.
  Outcome in_bash(const std::string& acts) const {
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "set -u\numask 022\nexport TACT_STUB_DHD_NO_WATCHDOG=1 XDG_RUNTIME_DIR="
        << in_folder("run") << "\ncd " << in_folder("")
        << "\nln -s " TACT_SOURCE_DIR "/model/scenes/* .\n"
        << kWords << "view=" << program_path("tact-view") << "\nctl=" << program_path("tactctl")
        << "\nmkdir run page; echo '<html></html>' >page/index.html\n"
        << "install -d -o daemon -g games -m 0750 run/tact\ninstall -d -m 0777 seen\n"
        << "$as_tactd " << program_path("tactd") << " liver.toml --viewers games --no-black-box"
        << kStubDevice
        << " >/dev/null 2>log & tactd=$!\ntrap 'kill -KILL $tactd' EXIT\n"
           "ready\n"
        << acts << "\nkill -INT $tactd; wait $tactd; trap - EXIT; cat log *.said\n";
    return run_command("timeout -k 5 90 bash " + script);
  }
};

TEST_F(ViewerUser, ViewerUserSeesFramesAndOtherUsersDoNot) {
  const Outcome out = in_bash(
      "stat -c 'telemetry %U %G %a' run/tact/telemetry.sock\n"
      "look_until_seen viewer \"$as_viewer\" --tactd-user daemon\n"
      "look stranger \"$as_stranger\" --tactd-user daemon\n"
      "look doubter \"$as_viewer\"\n");
  EXPECT_TRUE(has(out, "telemetry daemon games 660")) << out.output;
  EXPECT_TRUE(has(out, "viewer saw \"frames\":")) << out.output;
  EXPECT_FALSE(has(out, "viewer saw \"frames\":0")) << out.output;
  EXPECT_TRUE(has(out, "stranger saw \n")) << out.output;
  EXPECT_TRUE(has(out, "Permission denied")) << out.output;
  EXPECT_TRUE(has(out, "doubter saw \n")) << out.output;
  EXPECT_TRUE(has(out, "another user may put a socket there")) << out.output;
}

/// What the socket of tactctl answers the viewer's user on the word "arm"; errno where it lets him
/// not in.
std::string ask_as_viewer(const std::string& path) {
  std::array<int, 2> wire{};
  if (pipe(wire.data()) != 0) return "no pipe";
  const gid_t games = getgrnam("games")->gr_gid;
  const auto address = model::io::socket_address(path);
  const pid_t child = fork();
  if (child == 0) {
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    std::string answer(256, '\0');
    if (setgroups(1, &games) != 0 || setgid(65534) != 0 || setuid(65534) != 0) _exit(1);
    if (connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0)
      answer = strerrorname_np(errno);
    else if (send(fd, "arm", 3, MSG_NOSIGNAL) >= 0 || errno == EPIPE || errno == ECONNRESET) {
      ssize_t n = recv(fd, &answer[0], 256, 0);
      if (n < 0 && errno == ECONNRESET) n = recv(fd, &answer[0], 256, 0);  // it waits behind that
      answer.resize(static_cast<std::size_t>(std::max<ssize_t>(0, n)));
    }
    _exit(write(wire[1], answer.data(), answer.size()) < 0 ? 1 : 0);
  }
  close(wire[1]);
  std::string reported(256, '\0');
  const ssize_t n = read(wire[0], reported.data(), reported.size());
  reported.resize(static_cast<std::size_t>(std::max<ssize_t>(0, n)));
  close(wire[0]);
  waitpid(child, nullptr, 0);
  return reported;
}

TEST_F(ViewerUser, CannotArmEvenIfTheFileLetsItIn) {
  // The test speaks while bash waits for the file `asked`.
  const std::string acts =
      "touch at\nfor i in {1..200}; do [ -e asked ] && break; sleep .05; done\n"
      "$as_viewer $ctl liver.toml arm --folder run/tact; echo \"viewer $?\"\n"
      "$ctl liver.toml status --folder run/tact; $ctl liver.toml arm --folder run/tact\n";
  std::string closed, open;
  std::thread asker([&] {
    for (int i = 0; i < 400 && !std::filesystem::exists(in_folder("at")); ++i) usleep(50'000);
    const auto controls =
        firmware::console::find_controls(in_folder("run/tact"), in_folder("liver.toml"));
    if (controls.size() == 1) {
      closed = ask_as_viewer(controls[0].path);
      chmod(controls[0].path.c_str(), 0666);
      open = ask_as_viewer(controls[0].path);
    }
    std::ofstream(in_folder("asked")) << "\n";
  });
  const Outcome out = in_bash(acts);
  asker.join();
  EXPECT_EQ(closed, "EACCES");
  EXPECT_EQ(open, "-only the user of this tactd, and root, are heard");
  EXPECT_TRUE(has(out, "viewer 2")) << out.output;
  EXPECT_TRUE(has(out, ": ready, 0.000 N")) << out.output;
  EXPECT_TRUE(has(out, "armed, force is on")) << "by root: " << out.output;
}

}  // namespace tact::tests::viewer_user_test
