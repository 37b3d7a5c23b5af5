// SPDX-License-Identifier: Apache-2.0
// tact-doctor --fix and --undo on a small PC made of files.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "firmware/pc/pc_check.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tools/doctor/fix_plan.h"
#include "tools/doctor/undo_store.h"

namespace tact::tools::doctor::fix_test {

namespace fs = std::filesystem;
using tests::content;
using tests::Outcome;

const std::string kDeploy = TACT_SOURCE_DIR "/tools/deploy/";

/// What update-grub reads from a drop-in, on a PC with these CPUs and these parameters.
std::string grub_line(const std::string& file, const std::string& online,
                      const std::string& before = "quiet") {
  return tests::run_command("env GRUB_CMDLINE_LINUX='" + before + "' TACT_ONLINE=" + online +
                            " sh -euc '. " + file + "; echo \"$GRUB_CMDLINE_LINUX\"'")
      .output;
}

bool has(const Outcome& outcome, const std::string& text) {
  return outcome.output.find(text) != std::string::npos;
}

/// Four cores of which none is isolated, a slow governor, an interrupt on the last core.
class Fix : public testing::Test {
 protected:
  Fix() {
    std::string path = (fs::temp_directory_path() / "tact-fix-XXXXXX").string();
    root = mkdtemp(path.data());
    put("/proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1.192-1\n");
    put("/proc/cmdline", "BOOT_IMAGE=/vmlinuz quiet\n");
    put("/proc/irq/36/smp_affinity_list", "0-3\n");
    fs::create_directories(root + "/proc/irq/36/eth0");
    put(cpus + "online", "0-3\n");
    put(cpus + "isolated", "\n");
    put(cpus + "nohz_full", "\n");
    put(cpus + "cpu3/cpufreq/scaling_governor", "powersave\n");
  }
  ~Fix() override { fs::remove_all(root); }

  void put(const std::string& path, const std::string& text) const {
    fs::create_directories(fs::path(root + path).parent_path());
    std::ofstream(root + path, std::ios::binary) << text;
  }
  Outcome doctor(const std::string& words, const std::string& input = "/dev/null") const {
    return tests::run_program("tact-doctor", "--root " + root + " " + words + " <" + input);
  }
  /// Every file and folder with its permissions and content.
  std::map<std::string, std::string> all() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      struct stat info{};
      lstat(entry.path().c_str(), &info);
      found[entry.path()] =
          std::to_string(info.st_mode) + (entry.is_regular_file() ? content(entry.path()) : "");
    }
    return found;
  }
  const std::string cpus = "/sys/devices/system/cpu/";
  std::string root;
};

TEST_F(Fix, WritesWhatTheRowsAdviseAndSaysWhatIsLeft) {
  const Outcome out = doctor("--fix --yes");
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_EQ(content(root + kGrubDropIn), content(kDeploy + "rt/tact-rt.cfg"));
  EXPECT_EQ(content(root + kUnit), content(kDeploy + "rt/tact-rt.service"));
  EXPECT_EQ(content(root + kLimitsDropIn), content(kDeploy + "haptics.conf"));
  for (const char* path : {kGrubDropIn, kUnit, kLimitsDropIn}) {
    EXPECT_TRUE(has(out, "--- " + root + path)) << out.output;
    EXPECT_TRUE(has(out, content(root + path))) << "said before it is written: " << out.output;
  }
  EXPECT_TRUE(has(out, "+ update-grub\n")) << out.output;
  EXPECT_TRUE(has(out, "left to you:\n  kernel: sudo apt install linux-image-rt")) << out.output;
  EXPECT_FALSE(has(out, "  CPU governor: ")) << out.output;
}

TEST_F(Fix, TheKernelIsToldWhatTheRowsAdvise) {
  const std::string file = kDeploy + "rt/tact-rt.cfg";
  EXPECT_EQ(grub_line(file, "0-3"), "quiet " +
                                        firmware::pc::isolation_parameters(
                                            {.files = firmware::pc::PcFiles(root), .core = 3}) +
                                        "\n");
  EXPECT_EQ(grub_line(file, "0-1"),
            "quiet isolcpus=domain,managed_irq,1 nohz_full=1 rcu_nocbs=1 irqaffinity=0\n");
  EXPECT_EQ(grub_line(file, "0"), "quiet\n") << "one core is nobody's alone";
  EXPECT_EQ(grub_line(file, "0-3", "isolcpus=1"), "isolcpus=1\n") << "another file has decided";
  ASSERT_EQ(doctor("--fix --yes --core 2").status, 0);
  EXPECT_EQ(grub_line(root + kGrubDropIn, "0-3"),
            "quiet isolcpus=domain,managed_irq,2 nohz_full=2 rcu_nocbs=2 irqaffinity=0-1,3-3\n");
  EXPECT_NE(content(root + kUnit).find("\nEnvironment=TACT_CORE=2\n"), std::string::npos);
}

// One of the two adds the parameters, the doctor's first: it may name a core.
TEST_F(Fix, WhatThePackageTactRtHasIsNotWrittenAgain) {
  put(kPackagedGrubDropIn, content(kDeploy + "rt/tact-rt.cfg"));
  put("/lib/systemd/system/tact-rt.service", content(kDeploy + "rt/tact-rt.service"));
  put("/etc/security/limits.d/tact.conf", content(kDeploy + "haptics.conf"));
  const auto before = all();
  const Outcome out = doctor("--fix --yes");
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_TRUE(has(out, std::string(kPackagedGrubDropIn) + " is up to date\n")) << out.output;
  EXPECT_TRUE(has(out, "nothing to write")) << out.output;
  EXPECT_FALSE(has(out, "+ update-grub")) << out.output;
  EXPECT_EQ(all(), before);
  ASSERT_EQ(doctor("--fix --yes --core 1").status, 0);
  EXPECT_LT(std::string(kGrubDropIn), kPackagedGrubDropIn)
      << "the order in which update-grub reads";
  const std::string first = grub_line(root + kGrubDropIn, "0-3");
  EXPECT_NE(first.find("isolcpus=domain,managed_irq,1 "), std::string::npos) << first;
  EXPECT_EQ(grub_line(root + kPackagedGrubDropIn, "0-3", first.substr(0, first.size() - 1)), first);
}

TEST_F(Fix, TheUnitIsSound) {
  if (std::system("command -v systemd-analyze >/dev/null") != 0) GTEST_SKIP() << "no systemd";
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  const Outcome judged = tests::run_command("systemd-analyze verify --man=no " + root + kUnit +
                                            " 2>&1 | grep tact-pc");
  EXPECT_EQ(judged.output, "");
}

// Its commands on this small PC: the paths of /proc and /sys are the only change.
TEST_F(Fix, TheUnitSetsTheGovernorAndMovesTheInterrupts) {
  const std::string unit = content(kDeploy + "rt/tact-rt.service");
  std::istringstream lines(unit);
  std::string script;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("ExecStart=")) script += line.substr(10) + "\n";
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"$$", "$"},
                                 {"/sys/devices", root + "/sys/devices"},
                                 {"/proc/irq", root + "/proc/irq"}})
    for (std::size_t at = 0; (at = script.find(from, at)) != std::string::npos; at += to.size())
      script.replace(at, from.size(), to);
  for (const char* core : {"cpu0", "cpu1", "cpu2"}) fs::create_directories(root + cpus + core);
  put("/script", script);
  ASSERT_EQ(tests::run_command("TACT_CORE= sh -eu " + root + "/script").status, 0);
  EXPECT_EQ(content(root + cpus + "cpu3/cpufreq/scaling_governor"), "performance\n");
  EXPECT_EQ(content(root + "/proc/irq/36/smp_affinity_list"), "0,1,2\n");
  put(cpus + "isolated", "1\n");
  ASSERT_EQ(tests::run_command("TACT_CORE= sh -eu " + root + "/script").status, 0);
  EXPECT_EQ(content(root + "/proc/irq/36/smp_affinity_list"), "0,2,3\n");
  ASSERT_EQ(tests::run_command("TACT_CORE=0 sh -eu " + root + "/script").status, 0);
  EXPECT_EQ(content(root + "/proc/irq/36/smp_affinity_list"), "1,2,3\n");
}

TEST_F(Fix, TwiceIsAsOnce) {
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  const auto once = all();
  const Outcome again = doctor("--fix --yes");
  EXPECT_EQ(again.status, 0);
  EXPECT_TRUE(has(again, "nothing to write")) << again.output;
  EXPECT_FALSE(has(again, "+ update-grub")) << again.output;
  EXPECT_EQ(all(), once);
}

TEST_F(Fix, UndoPutsEveryByteBack) {
  const std::string own("mine\0 without end", 17);
  put(kGrubDropIn, own);
  chmod((root + kGrubDropIn).c_str(), 0600);
  put(kUnit, "");
  const auto before = all();
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  EXPECT_NE(content(root + kGrubDropIn), own);
  // Of a second --fix, for another core, the first one's files are not what was there before.
  ASSERT_EQ(doctor("--fix --yes --core 2").status, 0);
  EXPECT_NE(content(root + kGrubDropIn).find("\nTACT_CORE=2\n"), std::string::npos);
  const Outcome undone = doctor("--undo --yes");
  EXPECT_EQ(undone.status, 0) << undone.output;
  fs::remove(root + "/var/lib");  // empty, or this fails
  fs::remove(root + "/var");
  EXPECT_EQ(all(), before);
  EXPECT_TRUE(has(doctor("--undo --yes"), "nothing to take back"));
}

TEST_F(Fix, UndoKeepsWhatWasEditedSince) {
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  std::ofstream(root + kLimitsDropIn, std::ios::app) << "# mine\n";
  const Outcome undone = doctor("--undo --yes");
  EXPECT_EQ(undone.status, 1);
  EXPECT_TRUE(has(undone, std::string(kLimitsDropIn) + " was edited after --fix")) << undone.output;
  EXPECT_TRUE(fs::exists(root + kLimitsDropIn));
  EXPECT_FALSE(fs::exists(root + kUnit));
  fs::remove(root + kLimitsDropIn);
  const Outcome again = doctor("--undo --yes");
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_FALSE(has(again, "systemctl")) << "what is back is not taken back twice: " << again.output;
}

TEST_F(Fix, ASecondFixKeepsWhatWasEditedSince) {
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  std::ofstream(root + kLimitsDropIn, std::ios::app) << "# mine\n";
  const Outcome again = doctor("--fix --yes");
  EXPECT_EQ(again.status, 1);
  EXPECT_TRUE(has(again, std::string(kLimitsDropIn) + ": was edited after --fix")) << again.output;
  EXPECT_NE(content(root + kLimitsDropIn).find("# mine"), std::string::npos);
}

TEST_F(Fix, ADryRunWritesNothing) {
  const auto before = all();
  const Outcome out = doctor("--fix --dry-run");
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_TRUE(has(out, "isolcpus=domain")) << out.output;
  EXPECT_EQ(all(), before);
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  const auto after = all();
  EXPECT_EQ(doctor("--undo --dry-run").status, 0);
  EXPECT_EQ(all(), after);
}

TEST_F(Fix, NobodyToAskIsARefusal) {
  const auto before = all();
  const Outcome out = doctor("--fix");
  EXPECT_EQ(out.status, 2);
  EXPECT_TRUE(has(out, "nobody is there to be asked: say --yes")) << out.output;
  EXPECT_EQ(all(), before);
  EXPECT_EQ(doctor("--yes").status, 2);
  EXPECT_EQ(doctor("--fix --undo").status, 2);
}

TEST_F(Fix, AFolderThatOthersMayWriteToSaysNothingAboutUndo) {
  ASSERT_EQ(doctor("--fix --yes").status, 0);
  ASSERT_EQ(chmod((root + kUndoFolder).c_str(), 0777), 0);
  const Outcome out = doctor("--undo --yes");
  EXPECT_EQ(out.status, 2);
  EXPECT_TRUE(has(out, "others may write there")) << out.output;
  EXPECT_TRUE(fs::exists(root + kUnit));
}

TEST_F(Fix, ALinkIsNotWrittenThrough) {
  put("/etc/other", "other\n");
  fs::create_directories(fs::path(root + kLimitsDropIn).parent_path());
  fs::create_symlink(root + "/etc/other", root + kLimitsDropIn);
  EXPECT_EQ(doctor("--fix --yes").status, 1);
  EXPECT_EQ(content(root + "/etc/other"), "other\n");
}

TEST_F(Fix, OneCoreIsNotIsolatedNorOneThatAnotherFileIsolates) {
  put(cpus + "online", "0\n");
  EXPECT_FALSE(has(doctor("--fix --dry-run"), kGrubDropIn));
  put(cpus + "online", "0-3\n");
  put("/proc/cmdline", "quiet isolcpus=1\n");
  const Outcome out = doctor("--fix --dry-run");
  EXPECT_FALSE(has(out, kGrubDropIn)) << out.output;
  EXPECT_TRUE(has(out, "  isolated core: ")) << "left to a person: " << out.output;
}

// What has done only half of its work is not noted, and would not be taken back.
TEST_F(Fix, TheUnitIsEnabledAndStartedApart) {
  const Outcome out = doctor("--fix --dry-run");
  EXPECT_TRUE(has(out, "+ systemctl enable tact-pc.service\n")) << out.output;
  EXPECT_TRUE(has(out, "+ systemctl start tact-pc.service\n")) << out.output;
}

TEST(FixPlan, WhoAskedJoinsTheGroupAndIsTakenOutBeforeItGoes) {
  const auto commands = plan_fix({}, {}, {.user = "ann", .has_group = false}).commands;
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0].words.front(), "groupadd");
  EXPECT_EQ(commands[1].back, (std::vector<std::string>{"gpasswd", "-d", "ann", "haptics"}));
}

}  // namespace tact::tools::doctor::fix_test
