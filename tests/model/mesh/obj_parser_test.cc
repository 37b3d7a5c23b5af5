// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/obj_parser.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tact::model::mesh::obj_parser_test {

const std::string kVertices =
    "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n";

ObjText parse_good(const std::string& text) {
  const auto parsed = parse_obj(text, "m.obj");
  EXPECT_TRUE(parsed.has_value()) << (parsed ? "" : parsed.error().message);
  return parsed ? parsed.value() : ObjText{};
}

void expect_error(const std::string& text, std::size_t line, const std::string& part) {
  const auto parsed = parse_obj(text, "m.obj");
  ASSERT_FALSE(parsed.has_value()) << text;
  const std::string& message = parsed.error().message;
  const std::string start = "m.obj:" + std::to_string(line) + ": ";
  EXPECT_EQ(message.substr(0, start.size()), start) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << message;
  EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) {
    return c >= ' ' && c <= '~';
  })) << message;
}

TEST(ObjParser, ReadsNumbersAsTheyAreWritten) {
  const ObjText text = parse_good("v +1 -.5 .25\nv 1e3 -1.5E-2 +2.e1\nv 0e0 1e-310 -1e-400\n");
  ASSERT_EQ(text.vertex.size(), 3u);
  EXPECT_EQ(text.vertex[0], (Vec3{1.0, -0.5, 0.25}));
  EXPECT_EQ(text.vertex[1], (Vec3{1000.0, -0.015, 20.0}));
  EXPECT_EQ(text.vertex[2], (Vec3{0.0, 1e-310, 0.0}));
}

TEST(ObjParser, CountsNegativeNumbersFromTheVertexJustAbove) {
  const ObjText text =
      parse_good("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1/2/3 1 -3//-1\n");
  EXPECT_EQ(text.corner, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1}));
  EXPECT_EQ(text.face_end, (std::vector<std::uint32_t>{3, 6}));
  EXPECT_EQ(text.face_line, (std::vector<std::uint32_t>{4, 6}));
  EXPECT_EQ(text.lines, 6u);
}

TEST(ObjParser, AcceptsAFaceOfAThousandCorners) {
  std::string face = "f";
  for (std::size_t i = 0; i < kMaxFaceCorners; ++i) face += " 1";
  EXPECT_EQ(parse_good("v 0 0 0\n" + face + "\n").corner.size(), kMaxFaceCorners);
  expect_error("v 0 0 0\n" + face + " 1\n", 2, "more than 1000 corners");
}

TEST(ObjParser, NamesTheLineOfABrokenStatement) {
  expect_error("v 0 0 0\nv 1 inf 0\n", 2, "'inf' is not a finite number");
  expect_error("v 0 0 0\nv 1 -nan 0\n", 2, "not a finite number");
  expect_error("v 0 0 1e13\n", 1, "beyond 1e12");
  expect_error("v 0 0 -1e999\n", 1, "'-1e999' is beyond 1e12");
  expect_error("v 0 0 0x10\n", 1, "'0x10' is not a number");
  expect_error("v 0 0 +-1\n", 1, "not a number");
  expect_error("v 0 0 0 red\n", 1, "'red' is not a number");
  expect_error("v\n", 1, "0 of 3 numbers");
  expect_error(kVertices + "f\n", 9, "0 of at least 3 corners");
  expect_error(kVertices + "f 1 2 3x\n", 9, "'3x' is not a face corner");
  expect_error(kVertices + "f 1 2 3/1/1/1\n", 9, "not a face corner");
  expect_error(kVertices + "f 1 2 /3\n", 9, "not a face corner");
  expect_error(kVertices + "f 1.0 2.0 3.0\n", 9, "not a face corner");
  expect_error(kVertices + "f 1 2 99999999999999999999\n", 9, "not a face corner");
  expect_error(kVertices + "f 1 2 4294967299\n", 9, "names vertex 4294967299");
  expect_error(kVertices + "f -1 -2 -9\n", 9, "names vertex -9");
  expect_error("# a\n\nsolid cube\n", 3, "'solid' is not an OBJ statement");
  expect_error("v 0 0 \x01\x1B[2J\n", 1, "'??[2J'");
  expect_error("v 0 \\\n 0\nv 0 0 x\n", 1, "2 of 3 numbers");  // first line of a long statement
  expect_error("# two\r\nv 0 0\r\n", 2, "2 of 3 numbers");
  expect_error("v 0 0 0\rv 1 0\r", 2, "2 of 3 numbers");
}

TEST(ObjParser, ReadsTheColourOfEachVertexAndLeavesHalfColouredFilesPlain) {
  const auto color = [](const std::string& last) {
    const auto parsed = parse_obj("v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0\n" + last + "f 1 2 3\n", "a.obj");
    EXPECT_TRUE(parsed) << last;
    return parsed ? parsed->color : std::vector<Rgb>{};
  };
  EXPECT_EQ(color("v 0 1 0 .2 .4 1\n"),
            (std::vector<Rgb>{{255, 0, 128}, {0, 255, 0}, {51, 102, 255}}));
  for (const char* plain : {"v 0 1 0\n", "v 0 1 0 1\n", "v 0 1 0 1 1\n", "v 0 1 0 1 1 1.01\n",
                            "v 0 1 0 1 1 -0.1\n", "v 0 1 0 1 1 1 1\n"})
    EXPECT_TRUE(color(plain).empty()) << plain;
}

TEST(ObjParser, RefusesMoreVerticesThanTheLimitAtTheirLine) {
  std::string text;
  for (std::size_t i = 0; i <= kMaxObjVertices; ++i) text += "v 0 0 0\n";
  const auto parsed = parse_obj(text, "big.obj");
  ASSERT_FALSE(parsed.has_value());
  EXPECT_EQ(parsed.error().message,
            "big.obj:10000001: more than 10000000 vertices; simplify the mesh");
}

TEST(ObjParser, RefusesMoreTrianglesThanTheLimit) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f";
  for (std::size_t i = 0; i < kMaxFaceCorners; ++i) face += " 1";
  const std::size_t faces = kMaxObjTriangles / (kMaxFaceCorners - 2) + 1;
  for (std::size_t i = 0; i < faces; ++i) text += face + "\n";
  const auto parsed = parse_obj(text, "big.obj");
  ASSERT_FALSE(parsed.has_value());
  EXPECT_EQ(parsed.error().message, "big.obj:" + std::to_string(faces + 3) +
                                        ": more than 20000000 triangles; simplify the mesh");
}

}  // namespace tact::model::mesh::obj_parser_test
