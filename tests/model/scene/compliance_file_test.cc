// SPDX-License-Identifier: Apache-2.0
#include "model/scene/compliance_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "tests/support/compliance_map.h"
#include "tests/support/damage.h"
#include "tests/support/shapes.h"

namespace tact::model::scene::compliance_file_test {

namespace fs = std::filesystem;

tissue::ComplianceMap small_map() {
  return {.poisson_ratio = 0.45,
          .patch_radius_m = 0.008,
          .ring_pitch_m = 0.002,
          .rings = 3,
          .fixed_min_m = {-1.0, -2.0, -3.0},
          .fixed_max_m = {1.0, 2.0, 3.0},
          .inclusions = 9,
          .mesh_hash = "0123456789abcdef",
          .regular_times_E_per_m = {-1.5F, 40.0F},
          .sideways_times_E_per_m = {{1.0F, 2.0F, 3.0F, 4.0F, {0.0F, 0.0F, 1.0F}},
                                     {5.0F, 6.0F, 7.0F, 8.0F, {0.0F, 0.6F, 0.8F}}},
          .ring_times_E_per_m = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}};
}

class ComplianceFile : public testing::Test {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "map_" +
            testing::UnitTest::GetInstance()->current_test_info()->name() + ".compliance";
    const std::size_t bytes = tests::write_compliance_map(small_map(), path_);
    std::ifstream file(path_, std::ios::binary);
    content_.assign(std::istreambuf_iterator<char>(file), {});
    ASSERT_EQ(content_.size(), bytes);
  }
  void TearDown() override { fs::remove(path_); }

  /// What the reader says of these bytes; empty if it takes them.
  std::string verdict(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    const auto map = read_compliance_map(path_);
    return map ? "" : map.error().message;
  }
  bool says(const std::string& bytes, const std::string& words) {
    const std::string message = verdict(bytes);
    return message.find(words) != std::string::npos && message.find(path_) == 0 &&
           message.find("tact-lab condense") != std::string::npos;
  }

  std::string path_, content_;
};

TEST_F(ComplianceFile, GivesBackWhatWasWritten) {
  const auto back = read_compliance_map(path_);
  ASSERT_TRUE(back) << back.error().message;
  const tissue::ComplianceMap map = small_map();
  EXPECT_EQ(back->poisson_ratio, map.poisson_ratio);
  EXPECT_EQ(back->patch_radius_m, map.patch_radius_m);
  EXPECT_EQ(back->ring_pitch_m, map.ring_pitch_m);
  EXPECT_EQ(back->rings, map.rings);
  EXPECT_EQ(back->fixed_min_m, map.fixed_min_m);
  EXPECT_EQ(back->fixed_max_m, map.fixed_max_m);
  EXPECT_EQ(back->inclusions, map.inclusions);
  EXPECT_EQ(back->mesh_hash, map.mesh_hash);
  EXPECT_EQ(back->regular_times_E_per_m, map.regular_times_E_per_m);
  EXPECT_EQ(back->ring_times_E_per_m, map.ring_times_E_per_m);
  EXPECT_EQ(back->sideways_times_E_per_m[1].s2, 8.0F);
  EXPECT_EQ(back->sideways_times_E_per_m[1].axis, (std::array{0.0F, 0.6F, 0.8F}));
}

TEST_F(ComplianceFile, ReportsEveryDamage) {
  EXPECT_TRUE(says("", "no compliance map"));
  EXPECT_TRUE(says("an OBJ file", "no compliance map"));
  EXPECT_TRUE(says(content_.substr(0, 50), "ends within its header"));
  EXPECT_TRUE(says(content_.substr(0, content_.size() - 1), "bytes where"));
  EXPECT_TRUE(says(content_ + "x", "bytes where"));
  const auto with = [this](std::size_t at, const auto& value) {
    std::string bytes = content_;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
  };
  EXPECT_TRUE(says(with(8, std::uint32_t{7}), "version 7"));
  EXPECT_TRUE(says(with(12, std::uint32_t{0}), "0 vertices"));
  EXPECT_TRUE(says(with(12, std::uint32_t{0xFFFFFFFF}), "vertices"));
  EXPECT_TRUE(says(with(16, std::uint32_t{32}), "32 rings"));
  EXPECT_TRUE(says(with(24, std::nan("")), "no meaning"));
  for (std::size_t at = 8; at < content_.size(); ++at) {
    std::string bytes = content_;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    EXPECT_NE(verdict(bytes), "") << "byte " << at << " changed, unnoticed";
  }
}

TEST_F(ComplianceFile, NonFiniteNumbersAreRefused) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int list = 0; list < 3; ++list) {
      tissue::ComplianceMap map = small_map();
      (list == 0   ? map.regular_times_E_per_m[1]
       : list == 1 ? map.sideways_times_E_per_m[0].s1
                   : map.ring_times_E_per_m[4]) = bad;
      tests::write_compliance_map(map, path_);
      const auto read = read_compliance_map(path_);
      ASSERT_FALSE(read);
      EXPECT_NE(read.error().message.find("no finite number"), std::string::npos);
    }
    // the last ring, in a file whose checksum is right
    std::string bytes = content_.substr(0, content_.size() - 8);
    std::memcpy(bytes.data() + bytes.size() - 4, &bad, 4);
    std::uint64_t sum = 0xcbf29ce484222325u;
    for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    EXPECT_TRUE(says(bytes, "no finite number")) << verdict(bytes);
  }
}

TEST_F(ComplianceFile, EndsWithItsChecksum) {
  EXPECT_EQ(compliance_checksum(path_), content_.substr(content_.size() - 8));
  EXPECT_EQ(compliance_checksum(path_ + ".missing"), "");
  std::ofstream(path_, std::ios::binary) << "short";
  EXPECT_EQ(compliance_checksum(path_), "");
}

TEST_F(ComplianceFile, MissingFileIsReportedWithTheRemedy) {
  const auto map = read_compliance_map(path_ + ".missing");
  ASSERT_FALSE(map);
  EXPECT_NE(map.error().message.find("no such file; make it again with tact-lab condense"),
            std::string::npos);
}

TEST_F(ComplianceFile, EveryDamageIsReported) {
  tests::expect_all_damage_is_reported(
      path_, [](const std::string& path) { return !read_compliance_map(path); });
}

TEST(SurfaceHash, KnowsTheShapeAndNotThePlace) {
  mesh::SurfaceMesh plate = tests::make_plate(0.1, 3);
  const std::string hash = surface_hash(plate.view());
  for (Vec3& p : plate.vertex_m) p += Vec3{0.37, -0.11, 0.0301};
  EXPECT_EQ(surface_hash(plate.view()), hash);
  plate.vertex_m[5].z += 1e-6;
  EXPECT_NE(surface_hash(plate.view()), hash);
  EXPECT_NE(surface_hash(tests::make_plate(0.1, 4).view()), hash);
}

}  // namespace tact::model::scene::compliance_file_test
