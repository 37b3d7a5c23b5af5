// SPDX-License-Identifier: Apache-2.0
// cmake --install: what it copies runs from where it lies.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/program.h"

namespace tact::tools::deploy::installed_test {

namespace fs = std::filesystem;
using tests::Outcome;
using tests::run_command;

/// An empty prefix, and one component of the build below it.
class Installed : public testing::Test {
 protected:
  Installed()
      : prefix_(testing::TempDir() + "tact-installed-" + std::to_string(getpid()) + "-" +
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::create_directories(prefix_);
  }
  ~Installed() override { fs::remove_all(prefix_); }

  void install(const std::string& component) {
    const Outcome outcome = run_command("cmake --install " TACT_BINARY_DIR " --component " +
                                        component + " --prefix " + prefix_);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
  }
  /// From a folder that is none of tact's.
  Outcome run(const std::string& command) {
    return run_command("cd / && " + prefix_ + "/bin/" + command);
  }

  const std::string prefix_;
};

TEST_F(Installed, EveryShippedSceneRuns) {
  install("tact");
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(prefix_ + "/share/tact/scenes")) {
    const std::string scene = entry.path().string();
    if (!scene.ends_with(".toml") || scene.ends_with(".tracking.toml")) continue;
    const Outcome outcome =
        run("tactd " + scene + " --free-run --ticks 10 --no-telemetry --no-black-box");
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    ++scenes;
  }
  EXPECT_EQ(scenes, 8);
}

TEST_F(Installed, TheGuardianLiesBesideTactd) {
  install("tact");  // without it tactd refuses ODrives, CiA 402 drives and a Falcon
  const Outcome outcome = run("tact-guardian </dev/null");
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("tactd starts this program"), std::string::npos) << outcome.output;
}

TEST_F(Installed, NamesTheScenesWhereNoneIsGiven) {
  install("tact");
  const Outcome outcome = run("tactd /none.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find(prefix_ + "/share/tact/scenes/liver.toml"), std::string::npos)
      << outcome.output;
}

TEST_F(Installed, TheViewerServesTheInstalledPage) {
  if (!fs::exists(TACT_BINARY_DIR "/tact-view")) GTEST_SKIP() << "built without the viewer";
  install("tact-view");
  const std::string view =
      "timeout --signal=INT 5 " + prefix_ + "/bin/tact-view --port 0 --json --socket ";
  fs::remove_all(prefix_ + "/share/tact/page");
  EXPECT_NE(run_command(view + prefix_ + "/none").output.find(prefix_ + "/bin/page"),
            std::string::npos);
  fs::create_directories(prefix_ + "/share/tact/page");
  std::ofstream(prefix_ + "/share/tact/page/index.html") << "<html></html>";
  const Outcome outcome = run_command(view + prefix_ + "/none");
  EXPECT_NE(outcome.output.find("\"port\""), std::string::npos) << outcome.output;
}

TEST_F(Installed, TheFilesOfAPCLieWhereSystemdLooks) {
  install("tact");
  for (const char* path :
       {"lib/udev/rules.d/60-tact.rules", "lib/sysusers.d/tact.conf",
        "lib/systemd/system/tactd@.service", "lib/systemd/system/tact-awake@.service",
        "share/tact/pc/80-can0.network", "share/tact/pc/haptics.conf",
        "share/tact/pc/tactd-device.conf"})
    EXPECT_TRUE(fs::exists(prefix_ + "/" + path)) << path;
}

/// Programs, scripts, scenes, units and the page: a person who has no sources reads them.
TEST_F(Installed, NothingNamesAFileOfTheSourcesAlone) {
  for (const char* component : {"tact", "tact-view", "tact-tools", "tact-lab", "tact-rt"})
    install(component);
  const Outcome found = run_command("cd " + prefix_ +
                                    " && grep -raoE '(^|[^[:alnum:]_./-])(build|tools)/[a-z]+[^ "
                                    "]{0,20}|README[.a-z]*' bin lib share"
                                    " --exclude='*.md' --exclude-dir=__pycache__");
  EXPECT_EQ(found.status, 1) << found.output;
}

TEST_F(Installed, WithoutThePackageTheGroupIsMadeByAScriptOfThePrefix) {
  install("tact");
  install("tact-tools");
  const std::string script = prefix_ + "/share/tact/pc/make-group";
  EXPECT_EQ(run_command("sh -n " + script).status, 0);
  for (const char* file : {"/lib/sysusers.d/tact.conf", "/lib/udev/rules.d/60-tact.rules",
                           "/share/tact/pc/haptics.conf"})
    EXPECT_EQ(run_command("grep -q '\"$prefix" + std::string(file) + "\"' " + script).status, 0);
  // A PC whose files are empty: what its rights lack is red or unknown, with the remedy.
  fs::create_directories(prefix_ + "/pc/proc/self");
  std::ofstream(prefix_ + "/pc/proc/self/limits") << "Max realtime priority 0 0\n";
  const Outcome reported = run("tact-doctor --root " + prefix_ + "/pc");
  const bool has_group = run_command("getent group haptics").status == 0;
  EXPECT_EQ(reported.output.find("sudo '" + script + "', sudo adduser") == std::string::npos,
            has_group)
      << reported.output;
}

TEST_F(Installed, AMeshIsJudgedByTheToolsAndRepairedWithTheLab) {
  // Not by its programs: those of an earlier build with the lab may lie there.
  if (run_command("grep -qx TACT_LAB:BOOL=ON " TACT_BINARY_DIR "/CMakeCache.txt").status != 0)
    GTEST_SKIP() << "built without the lab";
  const std::string mesh = "tact-mesh " TACT_SOURCE_DIR "/model/scenes/meshes/liver_3116.obj";
  install("tact-tools");
  EXPECT_EQ(run(mesh).status, 0);
  const Outcome alone = run(mesh + " --smooth");
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.output.find("apt install tact-lab"), std::string::npos) << alone.output;
  install("tact-lab");
  EXPECT_EQ(run(mesh + " --smooth").status, 0);
}

/// Targets of a build that finds no solver.
TEST_F(Installed, TheLightToolsNeedNoSolver) {
  const Outcome configured = run_command("cmake -S " TACT_SOURCE_DIR " -B " + prefix_ +
                                         "/build -G Ninja -DTACT_LAB=OFF -DBUILD_TESTING=OFF "
                                         "-DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON");
  ASSERT_EQ(configured.status, 0) << configured.output;
  const std::string steps = run_command("cat " + prefix_ + "/build/build.ninja").output;
  for (const char* tool : {"doctor", "jitter", "limits", "mesh", "verify", "calibrate"})
    EXPECT_NE(steps.find("build tact-" + std::string(tool) + ":"), std::string::npos) << tool;
  for (const char* absent : {"benchmark", "build tact-lab:"})
    EXPECT_EQ(steps.find(absent), std::string::npos) << absent;
}

TEST_F(Installed, TheLightToolsAskForNoSolverAndNoOtherCompiler) {
  const Outcome asked =
      run_command("bash -c '. " TACT_SOURCE_DIR
                  "/tools/packages.sh; echo ${BUILD_PACKAGES[@]} ${LIGHT_TOOL_PACKAGES[@]}'");
  EXPECT_NE(asked.output.find("libfmt-dev"), std::string::npos) << asked.output;
  for (const char* absent : {"gmsh", "calculix", "scipy", "clang", "qemu", "nodejs", "vtk"})
    EXPECT_EQ(asked.output.find(absent), std::string::npos) << absent;
  EXPECT_NE(run_command(TACT_SOURCE_DIR "/tools/run --help").output.find("--tools"),
            std::string::npos);
}

}  // namespace tact::tools::deploy::installed_test
