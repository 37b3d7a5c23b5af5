// SPDX-License-Identifier: Apache-2.0
// What a scene says when a key is wrong depends on reading names as people do.
#include "model/reader/scene_text.h"

#include <gtest/gtest.h>

#include <array>

namespace tact::model::reader::scene_words_test {

TEST(SceneWords, ReadTheUnitFromTheEndOfAKey) {
  EXPECT_EQ(io::unit_of("depth_m"), "m");
  EXPECT_EQ(io::unit_of("tear_force_N"), "N");
  EXPECT_EQ(io::unit_of("sliding_stiffness_N_per_m"), "N/m");
  EXPECT_EQ(io::unit_of("dissipation_s_per_m"), "s/m");
  EXPECT_EQ(io::unit_of("slew_N_per_s"), "N/s");
  EXPECT_EQ(io::unit_of("damping_Ns_per_m"), "N s/m");
  EXPECT_EQ(io::unit_of("joint_damping_Nms_per_rad"), "N m s/rad");
  EXPECT_EQ(io::unit_of("torque_Nm"), "N m");
  EXPECT_EQ(io::unit_of("friction_ratio"), "");
  EXPECT_EQ(io::unit_of("units"), "");
  EXPECT_EQ(io::unit_of("due_ns"), "ns");
  EXPECT_EQ(io::unit_of("displacement_um"), "um");
}

TEST(SceneWords, DistinguishAWrongUnitFromAWrongKey) {
  EXPECT_TRUE(differs_only_in_unit("depth_mm", "depth_m"));
  EXPECT_TRUE(differs_only_in_unit("depth", "depth_m"));
  EXPECT_TRUE(differs_only_in_unit("force_mN", "force_N"));
  EXPECT_TRUE(differs_only_in_unit("rate_hz", "rate_Hz"));
  EXPECT_TRUE(differs_only_in_unit("normal_stiffness_N_per_mm", "normal_stiffness_N_per_m"));
  EXPECT_FALSE(differs_only_in_unit("depth_m", "depth_m"));
  EXPECT_FALSE(differs_only_in_unit("depths_m", "depth_m"));
  EXPECT_FALSE(differs_only_in_unit("unit", "units")) << "no unit to be wrong";
  EXPECT_FALSE(differs_only_in_unit("", "depth_m"));
}

TEST(SceneWords, FindTheNearestKeyOrNone) {
  constexpr std::array<std::string_view, 3> kKeys{"rod_length_m", "growth", "units"};
  EXPECT_EQ(nearest_key("rod_lenght_m", kKeys), 0u);
  EXPECT_EQ(nearest_key("grwth", kKeys), 1u);
  EXPECT_EQ(nearest_key("unit", kKeys), 2u);
  EXPECT_EQ(nearest_key("UNITS", kKeys), std::string_view::npos);
  EXPECT_EQ(nearest_key("", kKeys), std::string_view::npos);
  EXPECT_EQ(nearest_key("units", {}), std::string_view::npos);
  EXPECT_EQ(nearest_key(std::string(100000, 'x'), kKeys), std::string_view::npos);
}

TEST(SceneWords, KeepMessagesOnOneShortLine) {
  EXPECT_EQ(on_one_line("a\nb\tc\x1b[31m\x7f"), "a b c [31m ");
  EXPECT_EQ(on_one_line(std::string(80, 'x')), std::string(80, 'x'));
  EXPECT_EQ(on_one_line(std::string(81, 'x')), std::string(80, 'x') + "...");
  // A cut never splits a character: 79 bytes and a two-byte letter.
  EXPECT_EQ(on_one_line(std::string(79, 'x') + "\xc3\xa4"), std::string(79, 'x') + "...");
}

TEST(SceneWords, HashIsFnv1aOfTheTextAndItsEnd) {
  // FNV-1a: h = (h xor byte) * 0x100000001b3 from 0xcbf29ce484222325; "" is one end byte 0xff.
  TextHash none, empty, ab, a_b;
  EXPECT_EQ(none.hex(), "cbf29ce484222325");
  empty.add("");
  EXPECT_EQ(empty.hex(), "af64724c8602eb6e");  // one round with 0xff
  ab.add("ab");
  a_b.add("a");
  a_b.add("b");
  EXPECT_NE(ab.hex(), a_b.hex()) << "where a text ends matters";
}

}  // namespace tact::model::reader::scene_words_test
