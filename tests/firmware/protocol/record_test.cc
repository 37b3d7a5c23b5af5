// SPDX-License-Identifier: Apache-2.0
// Records by their tables: what is packed comes back, by name, from this and from another program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/record_text.h"
#include "firmware/protocol/run_file.h"
#include "host/record/operator_record.h"

namespace tact::firmware::protocol::record_test {

using nlohmann::json;

/// How often a table names each byte of the struct.
void mark(FieldTable fields, std::size_t at, std::vector<int>& named) {
  for (const Field& field : fields)
    for (std::size_t i = 0; i < field.count(); ++i) {
      if (field.record != nullptr) {
        mark(field.record(), at + field.offset_bytes + i * field.record_bytes, named);
        continue;
      }
      for (std::size_t k = 0; k < size_bytes_of(field.type); ++k)
        ++named.at(at + field.offset_bytes + i * size_bytes_of(field.type) + k);
    }
}

std::size_t packed_bytes(FieldTable fields) {
  std::size_t sum = 0;
  for (const Field& field : fields)
    sum += field.count() *
           (field.record != nullptr ? packed_bytes(field.record()) : size_bytes_of(field.type));
  return sum;
}

/// A member without a row is a hole that alignment does not explain.
template <typename Record>
void expect_all_named() {
  std::vector<int> named(sizeof(Record));
  mark(Record::fields(), 0, named);
  std::size_t hole = 0;
  for (const int times : named) {
    EXPECT_LE(times, 1);
    hole = times == 0 ? hole + 1 : 0;
    EXPECT_LT(hole, 8u) << Record::kName;
  }
}

TEST(Records, TheTablesNameEachMemberOnce) {
  expect_all_named<LoggedTick>();
  expect_all_named<Frame>();
  expect_all_named<host::record::OperatorRecord>();
  // Holes by alignment: a member of up to 7 bytes without a row changes the sum.
  EXPECT_EQ(sizeof(LoggedTick) - packed_bytes(LoggedTick::fields()), 74u);
  EXPECT_EQ(sizeof(Frame) - packed_bytes(Frame::fields()), 57u);
}

TEST(Records, FrameAndTickHoldTheContactsThatTheToolHas) {
  Frame frame;
  for (std::size_t i = 0; i < kMaxContacts; ++i)
    frame.contact[i].depth_m = static_cast<float>(i + 1);
  for (const std::size_t spheres : {std::size_t{1}, std::size_t{2}, kMaxContacts}) {
    const FieldTable fields = Frame::fields(spheres);
    std::string bytes;
    pack(fields, &frame, bytes);
    EXPECT_EQ(packed_bytes(Frame::fields()) - bytes.size(),
              (kMaxContacts - spheres) * packed_bytes(FrameContact::fields()));
    Frame back;
    ASSERT_TRUE(Unpacker::make(json_of(fields), Frame::fields())->unpack(bytes, &back));
    for (std::size_t i = 0; i < kMaxContacts; ++i)
      EXPECT_EQ(back.contact[i].depth_m, i < spheres ? frame.contact[i].depth_m : 0.0f) << i;
    EXPECT_EQ(packed_bytes(LoggedTick::fields()) - packed_bytes(LoggedTick::fields(spheres)),
              (kMaxContacts - spheres) * packed_bytes(LoggedContact::fields()));
    EXPECT_NE(csv_columns(LoggedTick::fields(spheres))
                  .find(fmt::format(",contact{0}_depth_m,contact{0}_state,contact{0}_state_name",
                                    spheres)),
              std::string::npos);
    EXPECT_EQ(csv_columns(LoggedTick::fields(spheres)).find(fmt::format("contact{}_", spheres + 1)),
              std::string::npos);
  }
}

template <typename Record>
Record random_record(std::mt19937& random) {
  Record out;
  std::string bytes(packed_bytes(Record::fields()), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  EXPECT_TRUE(Unpacker::make(json_of(Record::fields()), Record::fields())->unpack(bytes, &out));
  return out;
}

TEST(Records, PackAndUnpackRestoreRandomRecords) {
  std::mt19937 random(1);
  const auto unpacker = Unpacker::make(json_of(LoggedTick::fields()), LoggedTick::fields());
  ASSERT_TRUE(unpacker);
  for (int i = 0; i < 200; ++i) {
    const auto tick = random_record<LoggedTick>(random);
    std::string first, second;
    pack(LoggedTick::fields(), &tick, first);
    LoggedTick back;
    ASSERT_TRUE(unpacker->unpack(first, &back));
    pack(LoggedTick::fields(), &back, second);
    EXPECT_EQ(first, second);
  }
}

TEST(Records, FieldsOfAnotherVersionAreFoundByName) {
  Frame frame;
  frame.tick = 7;
  frame.contact[1].depth_m = 0.25f;
  std::string bytes;
  json table = json_of(Frame::fields());
  // A later program: its tick comes last, and it has a field that this one does not know.
  json tick = table[0];
  table.erase(0);
  table.push_back(tick);
  table.insert(table.begin(), json::parse(R"({"name": "new_N", "type": "f64", "shape": [2]})"));
  pack(Frame::fields(), &frame, bytes);
  bytes = std::string(16, '\1') + bytes.substr(8) + bytes.substr(0, 8);
  auto unpacker = Unpacker::make(table, Frame::fields());
  ASSERT_TRUE(unpacker);
  EXPECT_TRUE(unpacker->missing().empty());
  Frame back;
  ASSERT_TRUE(unpacker->unpack(bytes, &back));
  EXPECT_EQ(back.tick, 7u);
  EXPECT_EQ(back.contact[1].depth_m, 0.25f);
  // An earlier one: it had no contact losses.
  table.erase(table.size() - 1);
  unpacker = Unpacker::make(table, Frame::fields());
  ASSERT_TRUE(unpacker);
  EXPECT_EQ(unpacker->missing(), std::vector<std::string>{"tick"});
  EXPECT_FALSE(unpacker->unpack(bytes, &back)) << "the size is another";
  // One that gave it another type: a force of another meaning must not be read.
  table[1]["type"] = "f64";
  EXPECT_FALSE(Unpacker::make(table, Frame::fields()));
}

TEST(Records, ADamagedTableIsAnError) {
  const json good = json_of(Frame::fields());
  for (const json& bad : {json(), json("x"), json::array({1}), json::array({{{"name", 3}}}),
                          json::array({{{"name", "a"}, {"type", "f16"}}}),
                          json::array({{{"name", "a"}, {"type", "record"}}}),
                          json::array({{{"name", "a"}, {"type", "u8"}, {"shape", {-1}}}}),
                          json::array({{{"name", "a"}, {"type", "u8"}, {"shape", {1u << 30}}}}),
                          json::array({{{"name", "a"}, {"fields", 1}}})})
    EXPECT_FALSE(Unpacker::make(bad, Frame::fields())) << bad;
  // 65 536 times 65 536 elements, each of them nothing: must not be counted one by one.
  json many = json::array();
  for (int i = 0; i < 3; ++i)
    many = json::array({{{"name", "a"}, {"shape", {256, 256}}, {"fields", many}}});
  EXPECT_FALSE(Unpacker::make(many, Frame::fields()));
  many = json::array({{{"name", "b"}, {"type", "u8"}, {"shape", {256, 256}}}});
  for (int i = 0; i < 3; ++i)
    many = json::array({{{"name", "a"}, {"shape", {256, 256}}, {"fields", many}}});
  EXPECT_FALSE(Unpacker::make(many, Frame::fields()));
  json deep = good;
  for (int i = 0; i < 9; ++i) deep = json::array({{{"name", "a"}, {"fields", deep}}});
  EXPECT_FALSE(Unpacker::make(deep, Frame::fields()));
}

TEST(Records, AByteThatIsNoBoolBecomesOne) {
  Frame frame;
  std::string bytes;
  pack(Frame::fields(), &frame, bytes);
  std::string changed = bytes;
  frame.non_rt = true;
  std::string with;
  pack(Frame::fields(), &frame, with);
  const std::size_t at = static_cast<std::size_t>(
      std::mismatch(bytes.begin(), bytes.end(), with.begin()).first - bytes.begin());
  changed[at] = '\x7f';
  Frame back;
  ASSERT_TRUE(Unpacker::make(json_of(Frame::fields()), Frame::fields())->unpack(changed, &back));
  EXPECT_TRUE(back.non_rt);
  std::string again;
  pack(Frame::fields(), &back, again);
  EXPECT_EQ(again[at], '\1');
}

TEST(Records, ACsvHasAColumnForEachCellAndTheUnitLast) {
  const std::string columns = csv_columns(LoggedTick::fields());
  LoggedTick tick;
  tick.output.state = loop::State::kArmed;
  tick.output.written.force_N.y = 0.1;
  std::string row;
  append_csv(row, LoggedTick::fields(), &tick);
  EXPECT_EQ(std::ranges::count(columns, ','), std::ranges::count(row, ','));
  for (const char* name :
       {"tick,", ",tool_position_x_m,", ",tool_orientation_w,", ",phase_wake_ns,", ",force_y_N,",
        ",state,state_name,", ",limit,limit_name,"})
    EXPECT_NE(("," + columns + ",").find(name), std::string::npos) << name;
  EXPECT_NE(row.find(",2,armed,"), std::string::npos) << row;
  EXPECT_NE(row.find(",0.1,"), std::string::npos) << row;
}

}  // namespace tact::firmware::protocol::record_test
