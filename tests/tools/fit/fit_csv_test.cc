// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_csv.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace tact::tools::fit::fit_csv_test {

class FitCsv : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  const std::string& file(const std::string& text) {
    std::ofstream(path_) << text;
    return path_;
  }
  std::string error_of(const std::string& text, const BenchColumns& columns = {}) {
    const auto data = read_bench_csv(file(text), columns, {});
    return data ? "read" : data.error().message.substr(path_.size());
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() /
       (std::string("fit_csv_") + testing::UnitTest::GetInstance()->current_test_info()->name()))
          .string();
};

TEST_F(FitCsv, ReadsSitesRingsAndComments) {
  const auto data = read_bench_csv(file("# made by hand\n"
                                        "depth_m,force_N,site,u_0_m,u_1_m,spare\n"
                                        "radius_m,,,0,0.004,\n"
                                        "0.001,0.05,7,0.001,0.0004,x\n"
                                        "\n"
                                        "0.002, 0.12 ,7,0.002,0.0009,y\r\n"
                                        "-0.002,-0.1,9,-0.002,-0.0008,z\n"),
                                   {}, {"9"});
  ASSERT_TRUE(data) << data.error().message;
  ASSERT_EQ(data->sites.size(), 2U);
  EXPECT_EQ(data->sites[0].name, "7");
  EXPECT_FALSE(data->sites[0].held_out);
  EXPECT_TRUE(data->sites[1].held_out);
  EXPECT_EQ(data->sites[0].samples[1].force_N, 0.12);
  EXPECT_EQ(data->ring_radius_m, (std::vector<double>{0.0, 0.004}));
  EXPECT_EQ(data->sites[1].samples[0].ring_m, (std::vector<double>{-0.002, -0.0008}));
  EXPECT_EQ(data->farthest_pull_m(), 0.002);
}

TEST_F(FitCsv, TakesOtherNamesAndUnits) {
  const auto data = read_bench_csv(
      file("compression_mm,load_mean_N\n0.000,-0.07\n0.300,0.05\n15.0,21.5\n"),
      {.depth = "compression_mm", .force = "load_mean_N", .depth_unit_m = 0.001}, {});
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_DOUBLE_EQ(data->deepest_m(), 0.015);
  EXPECT_DOUBLE_EQ(data->peak_N(), 21.5);
}

TEST_F(FitCsv, LeavesOutWhatIsDeeperThanAsked) {
  const auto data = read_bench_csv(file("depth_m,force_N\n3,0.1\n6,0.2\n9,0.3\n9.1,0.9\n"),
                                   {.depth_unit_m = 0.001, .deepest_m = 0.009}, {});
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->sites[0].samples.size(), 3U);
  EXPECT_EQ(data->peak_N(), 0.3);
}

TEST_F(FitCsv, NamesTheLineOfEveryError) {
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,0.05\n0.002,soft\n"),
            ":3: force_N: \"soft\" is no number");
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,0.05,3\n"),
            ":2: 3 values, but line 1 names 2 columns; write one value for each");
  EXPECT_EQ(error_of("# note\ncompression_mm,force_N\n1,2\n"),
            ":2: no column depth_m among compression_mm, force_N; name it with --depth-column");
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,0.05\n3.0,0.1\n"),
            ":3: depth_m = 3 is 3 m deep; say what its unit is with --depth-unit-m (0.001 for mm)");
  EXPECT_EQ(error_of("depth_m,force_N,u_0_m\n0.001,0.05,0.001\n").substr(0, 21),
            ":1: columns u_0_m, ..");
  EXPECT_EQ(error_of("depth_m,force_N,u_0_m,u_1_m\nradius_m,,0.004,0.002\n"),
            ":2: the radii must rise from 0");
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,nan\n"), ":2: force_N: \"nan\" is no number");
}

TEST_F(FitCsv, RefusesTooLittle) {
  EXPECT_EQ(error_of(""), ": is empty; check the name");
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,1\n"), ": 1 rows; a fit needs 3 at least");
  EXPECT_EQ(error_of("depth_m,force_N\n0.001,0\n0.002,0\n0.003,0\n"),
            ": every force is 0; nothing can be fitted to that");
  const std::string& path = file("depth_m,force_N\n0.001,1\n0.002,2\n0.003,3\n");
  EXPECT_FALSE(read_bench_csv(path, {}, {"nowhere"}));
  EXPECT_FALSE(read_bench_csv(path, {}, {"bench"}));  // nothing left to fit
}

TEST_F(FitCsv, ReadsForceOverTime) {
  const auto held = read_relaxation_csv(file("time_s,force_N\n0,1\n0.5,0.8\n1,0.7\n"), {});
  ASSERT_TRUE(held) << held.error().message;
  EXPECT_EQ(held->size(), 3U);
  EXPECT_EQ((*held)[1].force_N, 0.8);
  const auto back = read_relaxation_csv(file("time_s,force_N\n0,1\n0,0.8\n"), {});
  ASSERT_FALSE(back);
  EXPECT_NE(back.error().message.find(":3: time_s does not rise"), std::string::npos);
}

}  // namespace tact::tools::fit::fit_csv_test
