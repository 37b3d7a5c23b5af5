// SPDX-License-Identifier: Apache-2.0
#include "host/server/page_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/message.h"

namespace tact::host::server::page_files_test {

using tests::message_of;

namespace fs = std::filesystem;

class PageFolder : public ::testing::Test {
 protected:
  PageFolder() : folder_(fs::temp_directory_path() / ("tact-page-" + std::to_string(getpid()))) {
    fs::create_directories(folder_ / "page" / "assets");
    write("secret.txt", "secret");
    write("page/index.html", "<html>");
    write("page/assets/a.js", "1");
    fs::create_symlink(folder_ / "secret.txt", folder_ / "page" / "link.txt");
  }
  ~PageFolder() override { fs::remove_all(folder_); }
  void write(const char* name, const char* content) { std::ofstream(folder_ / name) << content; }
  std::string page() const { return (folder_ / "page").string(); }

  fs::path folder_;
};

TEST_F(PageFolder, IsServedByExactPathOnly) {
  PageFiles files;
  ASSERT_EQ(message_of(files.load(page())), "");
  ASSERT_NE(files.find("/"), nullptr);
  EXPECT_EQ(files.find("/")->content, "<html>");
  EXPECT_EQ(files.find("/index.html")->mime, "text/html; charset=utf-8");
  EXPECT_EQ(files.find("/assets/a.js")->mime, "text/javascript; charset=utf-8");
}

TEST_F(PageFolder, GivesNothingOutsideItself) {
  PageFiles files;
  ASSERT_EQ(message_of(files.load(page() + "/")), "");
  for (const char* path : {"/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt",
                           "//etc/passwd", "/etc/passwd", "", "assets/a.js", "/assets", "/link.txt",
                           "/./index.html", "/..\\secret.txt"}) {
    EXPECT_EQ(files.find(path), nullptr) << path;
  }
}

TEST_F(PageFolder, WithoutAPageIsAnErrorThatSaysHowToGetOne) {
  PageFiles files;
  EXPECT_NE(message_of(files.load((folder_ / "page" / "assets").string())).find("--page"),
            std::string::npos);
  EXPECT_NE(message_of(files.load((folder_ / "nowhere").string())).find("--page"),
            std::string::npos);
}

}  // namespace tact::host::server::page_files_test
