// SPDX-License-Identifier: Apache-2.0
// What is made from the tables of firmware/protocol: rows of host/PROTOCOL.md, types of the page,
// the JSON schema of a frame. Where one differs, TACT_WRITE_GENERATED=1 writes it:
//
//     TACT_WRITE_GENERATED=1 build/tests/firmware_protocol_test --gtest_filter='Generated.*'
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_file.h"
#include "hal/sim/hand_target.h"
#include "host/record/operator_record.h"
#include "host/server/frame_json.h"

namespace tact::firmware::protocol::generated_text_test {

using nlohmann::json;
using nlohmann::ordered_json;

const std::string kRoot = TACT_SOURCE_DIR "/";
constexpr const char* kBegin = "<!-- made from firmware/protocol -->\n";
constexpr const char* kEnd = "<!-- end -->\n";

std::string content_of(const std::string& path) {
  std::ifstream file(kRoot + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The file must have this content; it is written where that is asked for.
void expect_content(const std::string& path, const std::string& content) {
  if (std::getenv("TACT_WRITE_GENERATED") != nullptr) std::ofstream(kRoot + path) << content;
  EXPECT_TRUE(content_of(path) == content)
      << path << " differs from the tables of firmware/protocol; TACT_WRITE_GENERATED=1 "
      << "build/tests/firmware_protocol_test --gtest_filter='Generated.*' writes it";
}

std::string type_text(const json& row) {
  std::string out = row.contains("fields") ? "record" : row.at("type");
  for (const json& length : row.value("shape", json::array()))
    out += fmt::format("[{}]", length.get<int>());
  return out;
}

/// Rows of one record; those of a record in it follow with its name before theirs.
std::string markdown_rows(FieldTable fields, const std::string& prefix = "") {
  std::string out;
  for (const json& row : json_of(fields)) {
    std::string meaning = row.at("meaning");
    if (row.contains("values")) {
      std::string values;
      for (std::size_t i = 0; i < row["values"].size(); ++i)
        values +=
            fmt::format("{}{} {}", i == 0 ? "" : ", ", i, row["values"][i].get<std::string>());
      meaning = values + (meaning.empty() ? "" : "; " + meaning);
    }
    out += fmt::format("| `{}{}` | `{}` | {} | {} |\n", prefix, row.at("name").get<std::string>(),
                       type_text(row), row.value("unit", ""), meaning);
  }
  for (const Field& field : fields)
    if (field.record != nullptr) out += markdown_rows(field.record(), prefix + field.name + ".");
  return out;
}

template <typename Record>
std::string markdown() {
  const Record record;
  return fmt::format(
             "\n### {}, kind {}, {} bytes\n\n| field | type | unit | what |\n|---|---|---|---|\n",
             Record::kName, static_cast<int>(Record::kKind),
             chunk_of(record).size() - sizeof(ChunkHeader)) +
         markdown_rows(Record::fields());
}

TEST(Generated, TheDocumentHasTheFieldsOfEachRecord) {
  std::string text = content_of("host/PROTOCOL.md");
  const std::size_t from = text.find(kBegin), to = text.find(kEnd);
  ASSERT_TRUE(from != text.npos && to != text.npos);
  text.replace(from, to - from,
               kBegin + markdown<LoggedTick>() + markdown<Frame>() +
                   markdown<host::record::OperatorRecord>() + "\n");
  expect_content("host/PROTOCOL.md", text);
}

std::string array_type(std::size_t n) {
  if (n == 3) return "Vec";
  return n == 4 ? "[number, number, number, number]" : "number[]";
}

std::string interface_of(const char* name, FieldTable fields) {
  std::string out = fmt::format("\nexport interface {} {{\n", name);
  for (const Field& field : fields) {
    if (field.record != nullptr) continue;
    const bool is_bool = field.type == FieldType::kBool;
    out += fmt::format("  {}: {};", field.name,
                       field.shape[0] > 0 ? array_type(field.shape[0])
                       : is_bool          ? "boolean"
                                          : "number");
    if (*field.meaning != '\0') out += fmt::format(" // {}", field.meaning);
    out += '\n';
  }
  return out + "}\n";
}

/// The type of a value of the head; a list is that of its first element.
std::string type_of_value(const json& value, const std::string& indent) {
  if (value.is_string()) return "string";
  if (value.is_boolean()) return "boolean";
  if (value.is_number()) return "number";
  if (value.is_array()) {
    const bool is_vector = value.size() == 3 && value[0].is_number();
    return is_vector ? "Vec" : type_of_value(value.at(0), indent) + "[]";
  }
  std::string out = "{\n";
  for (const auto& [key, inner] : value.items())
    out += fmt::format("{}  {}: {};\n", indent, key, type_of_value(inner, indent + "  "));
  return out + indent + '}';
}

TEST(Generated, ThePageHasTheTypesOfFrameAndHead) {
  RunHeader header;
  header.overrides = {"law=\"rhombus\""};
  header.spheres.resize(1);
  header.piece_color_ratio.resize(1);
  header.tasks.resize(1);
  const json scene = json::parse(host::server::scene_json(header));
  std::string text =
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// records.ts - made from the tables of firmware/protocol by firmware_protocol_test: change "
      "those, then\n"
      "// TACT_WRITE_GENERATED=1 build/tests/firmware_protocol_test "
      "--gtest_filter='Generated.*'\n\n"
      "export type Vec = [number, number, number];\n"
      "\n/** What runs: run_header.h says what each field is. */\nexport interface Scene ";
  text += type_of_value(scene, "") + "\n";
  text += interface_of("FrameFields", Frame::fields());
  text += interface_of("ContactFields", FrameContact::fields());
  expect_content("host/web/src/link/records.ts", text);
}

ordered_json schema_of(FieldTable fields) {
  ordered_json out;
  for (const Field& field : fields) {
    if (field.record != nullptr) continue;
    ordered_json type{{"type", field.type == FieldType::kBool ? "boolean" : "integer"}};
    if (field.type == FieldType::kF32 || field.type == FieldType::kF64)
      type["type"] = {"null", "number"};  // a number that is not finite
    if (field.shape[0] > 0) type = {{"type", "array"}, {"items", type}};
    out[field.name] = type;
  }
  return out;
}

void put_fields(ordered_json& object, FieldTable fields, const std::vector<std::string>& others) {
  ordered_json properties = schema_of(fields);
  object["required"] = ordered_json::array();
  for (const auto& [name, type] : properties.items()) object["required"].push_back(name);
  for (const std::string& name : others) {
    properties[name] = object["properties"].at(name);
    if (name != "patch") object["required"].push_back(name);  // of a mass-spring law alone
  }
  object["properties"] = properties;
}

TEST(Generated, TheSchemaHasTheFieldsOfAFrame) {
  const std::string path = "tools/schema/tact-live.schema.json";
  ordered_json schema = ordered_json::parse(content_of(path));
  for (ordered_json& message : schema["oneOf"]) {
    if (message["properties"]["kind"]["const"] != "frame") continue;
    put_fields(message["properties"]["contacts"]["items"], FrameContact::fields(), {"contact"});
    put_fields(message, Frame::fields(), {"kind", "contacts", "patch"});
  }
  expect_content(path, schema.dump(1) + "\n");
}

TEST(Generated, TheDocumentHasTheHandTarget) {
  using hal::sim::HandTarget;
  const std::string text = content_of("host/PROTOCOL.md");
  for (const auto& [name, offset] :
       std::map<std::string, std::size_t>{{"magic", offsetof(HandTarget, magic)},
                                          {"version", offsetof(HandTarget, version)},
                                          {"position_m", offsetof(HandTarget, position_m)},
                                          {"rotation_rad", offsetof(HandTarget, rotation_rad)},
                                          {"grip_ratio", offsetof(HandTarget, grip_ratio)}})
    EXPECT_NE(text.find(fmt::format("| `{}` | {} |", name, offset)), std::string::npos) << name;
  EXPECT_NE(text.find(fmt::format("### HandTarget, {} bytes", sizeof(HandTarget))),
            std::string::npos);
}

}  // namespace tact::firmware::protocol::generated_text_test
