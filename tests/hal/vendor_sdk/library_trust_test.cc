// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/library_trust.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/message.h"

namespace tact::hal::vendor_sdk::library_trust_test {

using tests::message_of;

constexpr const char* kRemedy = "let root install it";

/// A folder of the test's own in the place of the system's, and the user in the place of root.
class LibraryTrust : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(top + "/opt/fd");
    std::filesystem::create_directories(top + "/home");
    for (const char* file : {"/opt/fd/libdhd.so.3", "/home/libdhd.so.3"}) {
      std::ofstream(top + file) << "not loaded here";
      set_mode(file, 0644);
    }
    for (const char* folder : {"", "/opt", "/opt/fd"}) set_mode(folder, 0755);
  }
  void TearDown() override { std::filesystem::remove_all(top); }
  void set_mode(const std::string& of, mode_t mode) const {
    ASSERT_EQ(chmod((top + of).c_str(), mode), 0);
  }
  std::string refusal(const std::string& name) const {
    const auto file = find_library(name, folders);
    return file ? message_of(distrust_library(*file, kRemedy, folders)) : file.error().message;
  }
  void expect_refusal(const std::string& name, const std::vector<std::string>& words) const {
    for (const std::string& word : words)
      EXPECT_NE(refusal(name).find(word), std::string::npos) << word << " in " << refusal(name);
  }
  const std::string top = std::filesystem::canonical(testing::TempDir()).string() + "/tact-trust-" +
                          std::to_string(getpid());
  const std::string good = top + "/opt/fd/libdhd.so.3";
  LibraryFolders folders{.searched = {top + "/none", top + "/opt/fd"},
                         .allowed = {top + "/opt"},
                         .top = top,
                         .owner = geteuid()};
};

TEST_F(LibraryTrust, AFileOfTheOwnerBelowAnAllowedFolderIsTakenByPathAndByName) {
  for (const std::string& name : {good, std::string("libdhd.so.3")}) {
    EXPECT_EQ(*find_library(name, folders), good);
    EXPECT_EQ(refusal(name), "");
  }
}

TEST_F(LibraryTrust, OtherFoldersAreRefusedAlsoByALinkAndByDots) {
  expect_refusal(top + "/home/libdhd.so.3", {"below no system folder, nor /opt", kRemedy});
  expect_refusal(top + "/opt/../home/libdhd.so.3", {"below no system"});
  std::filesystem::create_symlink(top + "/home/libdhd.so.3", top + "/opt/fd/link.so");
  expect_refusal(top + "/opt/fd/link.so", {"below no system", "/home/libdhd.so.3"});
  folders.allowed = {top + "/op"};
  expect_refusal(good, {"below no system"});
}

TEST_F(LibraryTrust, FileWritableByOthersIsRefusedWithModeAndRemedy) {
  for (const mode_t mode : {mode_t{0664}, mode_t{0646}, mode_t{0666}}) {
    set_mode("/opt/fd/libdhd.so.3", mode);
    expect_refusal(good, {"others than its owner may write " + good, kRemedy});
  }
  set_mode("/opt/fd/libdhd.so.3", 0664);
  expect_refusal(good, {"mode 0664", "owner " + std::to_string(geteuid())});
}

TEST_F(LibraryTrust, EveryFolderOnTheWayCounts) {
  for (const char* folder : {"/opt/fd", "/opt", ""})
    for (const mode_t mode : {mode_t{0775}, mode_t{0757}, mode_t{01777}}) {
      set_mode(folder, mode);
      expect_refusal(good, {"others than its owner may write " + top + folder + " "});
      set_mode(folder, 0755);
    }
  EXPECT_EQ(refusal(good), "");
}

TEST_F(LibraryTrust, AnotherOwnerIsRefused) {
  folders.owner = geteuid() + 1;
  expect_refusal(good, {good + " belongs to user " + std::to_string(geteuid()) + " (mode 0644)"});
}

TEST_F(LibraryTrust, MissingOrIrregularFileIsReported) {
  expect_refusal(top + "/opt/none.so", {"none.so: No such file"});
  expect_refusal("libnone.so", {"libnone.so: in no system folder"});
  expect_refusal(top + "/opt/fd", {"it is no file"});
}

TEST(SystemFolders, HoldTheSystemsOwnLibraries) {
  const auto file = find_library("libm.so.6");
  ASSERT_TRUE(file);
  EXPECT_EQ(message_of(distrust_library(*file, kRemedy)), "");
  EXPECT_NE(message_of(distrust_library("/proc/self/exe", kRemedy)), "");
}

}  // namespace tact::hal::vendor_sdk::library_trust_test
