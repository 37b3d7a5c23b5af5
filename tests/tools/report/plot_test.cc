// SPDX-License-Identifier: Apache-2.0
// Needs gnuplot: without it every plot is an error that says what to install.
#include "tools/report/plot.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/files.h"
#include "tools/report/table.h"

namespace tact::tools::report::plot_test {

namespace fs = std::filesystem;
using tests::content;

class PictureFiles : public testing::Test {
 protected:
  PictureFiles() : folder_(testing::TempDir() + "tact's pictures " + std::to_string(getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    Table table("curve");
    for (int i = 0; i < 5; ++i) table.add({{"x_m", 0.1 * i}, {"force_N", 0.3 * i * i}});
    EXPECT_TRUE(table.write(folder_));
  }
  ~PictureFiles() override { fs::remove_all(folder_); }
  std::string folder_;  // with a quote and a space, as people have them
};

TEST_F(PictureFiles, DrawsSvgAndPngFromATable) {
  const auto files = draw(
      {.name = "curve",
       .script = "set xlabel 'depth, m'\nplot 'curve.csv' using 2:3 with points title 'force'\n"},
      folder_);
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_EQ(files->size(), 2u);
  EXPECT_NE(content((*files)[0]).find("<svg"), std::string::npos);
  EXPECT_NE(content((*files)[0]).find("depth, m"), std::string::npos);
  EXPECT_EQ(content((*files)[1]).substr(1, 3), "PNG");
  EXPECT_TRUE(fs::exists(folder_ + "/curve.gp")) << "anyone can draw it again";
  EXPECT_FALSE(fs::exists(folder_ + "/curve.gnuplot.txt"));
}

TEST_F(PictureFiles, AScriptReadsTheTextInFrontOfIt) {
  const auto files =
      draw({.name = "tact's",
            .script = "set xlabel caption\nplot for [i=1:words(list)] $block using 1:($2*factor) "
                      "with lines title word(list, i)\n",
            .variables = {{"caption", "50 N/m, the liver's"},
                          {"factor", 0.5},
                          {"list", std::vector<std::string>{"two words", "gum's"}},
                          {"$block", "x,y\n0,1\n1,2\n"}}},
           folder_);
  ASSERT_TRUE(files) << files.error().message;
  const std::string svg = content((*files)[0]);
  for (const char* said : {"50 N/m, the liver's", ">two words<", ">gum's<"})
    EXPECT_NE(svg.find(said), std::string::npos) << said;
}

TEST_F(PictureFiles, TheSameScriptGivesTheSameBytes) {
  const Plot plot{.name = "curve", .script = "plot 'curve.csv' using 2:3 with lines\n"};
  const auto files = draw(plot, folder_);
  ASSERT_TRUE(files);
  const std::string svg = content((*files)[0]), png = content((*files)[1]);
  ASSERT_TRUE(draw(plot, folder_));
  EXPECT_EQ(content((*files)[0]), svg);
  EXPECT_EQ(content((*files)[1]), png);
}

TEST_F(PictureFiles, ABrokenScriptIsAnErrorThatQuotesGnuplot) {
  const auto files = draw({.name = "broken", .script = "plot 'none.csv' using\n"}, folder_);
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("gnuplot"), std::string::npos);
}

TEST_F(PictureFiles, WithoutGnuplotItSaysWhatToInstall) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  const auto files = draw({.name = "curve", .script = "plot x\n"}, folder_);
  setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("apt install gnuplot-nox"), std::string::npos)
      << files.error().message;
}

}  // namespace tact::tools::report::plot_test
