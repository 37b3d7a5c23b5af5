// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/record_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "model/io/unit_name.h"

namespace tact::firmware::protocol {
namespace {

using model::Error;
using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "records are copied as they are");

struct TypeEntry {
  const char* name;
  std::size_t size_bytes;
};

/// Indexed by FieldType.
constexpr std::array<TypeEntry, 11> kTypes{{{"bool", 1},
                                            {"u8", 1},
                                            {"u16", 2},
                                            {"u32", 4},
                                            {"u64", 8},
                                            {"i16", 2},
                                            {"i32", 4},
                                            {"i64", 8},
                                            {"f32", 4},
                                            {"f64", 8},
                                            {"record", 0}}};
static_assert(kTypes.size() == static_cast<std::size_t>(FieldType::kRecord) + 1);

// Chosen; bounds what a damaged table can ask for.
constexpr std::size_t kMaxRecordBytes = 1 << 16;
constexpr int kMaxDepth = 4;  // of records in records

/// A row of a table in a file.
struct Stored {
  std::string name;
  FieldType type;
  std::size_t count;
  const json* record;  // of kRecord: its table
};

model::Result<Stored> stored_of(const json& row) {
  const Error invalid{"its table of fields is invalid"};
  if (!row.is_object() || !row.contains("name") || !row["name"].is_string()) return invalid;
  Stored out{.name = row["name"], .type = FieldType::kRecord, .count = 1, .record = nullptr};
  if (row.contains("fields")) {
    out.record = &row["fields"];
    // Each element has a byte at least, so kMaxRecordBytes bounds their number, too.
    if (!out.record->is_array() || out.record->empty()) return invalid;
  } else {
    const std::string type = row.value("type", json()).is_string() ? row["type"] : json("");
    const auto* const entry = std::ranges::find(kTypes, type, &TypeEntry::name);
    if (entry == kTypes.end() || entry->size_bytes == 0) return invalid;
    out.type = static_cast<FieldType>(entry - kTypes.begin());
  }
  for (const json& length : row.value("shape", json::array())) {
    if (!length.is_number_integer() || length < 1) return invalid;
    const auto n = length.get<std::size_t>();
    if (n > kMaxRecordBytes || out.count * n > kMaxRecordBytes) return invalid;
    out.count *= n;
  }
  return out;
}

}  // namespace

std::size_t size_bytes_of(FieldType type) {
  return kTypes[static_cast<std::size_t>(type)].size_bytes;
}

void pack(FieldTable fields, const void* record, std::string& out) {
  const char* const bytes = static_cast<const char*>(record);
  for (const Field& field : fields) {
    const char* const from = bytes + field.offset_bytes;
    if (field.record == nullptr) {
      out.append(from, field.count() * size_bytes_of(field.type));
      continue;
    }
    for (std::size_t i = 0; i < field.count(); ++i)
      pack(field.record(), from + i * field.record_bytes, out);
  }
}

json json_of(FieldTable fields) {
  json out = json::array();
  for (const Field& field : fields) {
    json row{{"name", field.name}, {"meaning", field.meaning}};
    if (field.record != nullptr)
      row["fields"] = json_of(field.record());
    else
      row["type"] = kTypes[static_cast<std::size_t>(field.type)].name;
    for (const std::size_t length : field.shape)
      if (length > 0) row["shape"].push_back(length);
    if (const auto unit = model::io::unit_of(field.name); !unit.empty()) row["unit"] = unit;
    for (const char* const component : field.components) row["components"].push_back(component);
    // A fault has a table of its own, and a larger type.
    for (std::uint64_t i = 0; field.label != nullptr && field.type == FieldType::kU8; ++i) {
      if (field.label(i) == std::string_view("unknown")) break;
      row["values"].push_back(field.label(i));
    }
    out.push_back(std::move(row));
  }
  return out;
}

std::optional<Error> Unpacker::add(const json& stored, FieldTable fields, std::size_t to_bytes,
                                   int depth) {
  if (!stored.is_array() || depth > kMaxDepth) return Error{"its table of fields is invalid"};
  std::vector<std::string> found;
  for (const json& row : stored) {
    const auto file = stored_of(row);
    if (!file) return file.error();
    found.push_back(file->name);
    const auto ours = std::ranges::find(fields, file->name,
                                        [](const Field& field) { return std::string(field.name); });
    const bool is_ours = ours != fields.end();
    if (is_ours && ours->type != file->type)
      return Error{fmt::format("its field {} has another type than in this program", file->name)};
    const std::size_t count = is_ours ? std::min(file->count, ours->count()) : 0;
    if (file->record == nullptr) {
      const std::size_t size_bytes = size_bytes_of(file->type);
      if (is_ours)
        steps_.push_back({stored_bytes_, to_bytes + ours->offset_bytes, count * size_bytes,
                          file->type == FieldType::kBool});
      stored_bytes_ += file->count * size_bytes;
    } else {
      for (std::size_t i = 0; i < file->count; ++i) {
        const bool is_kept = i < count;
        if (auto error = add(*file->record, is_kept ? ours->record() : FieldTable{},
                             is_kept ? to_bytes + ours->offset_bytes + i * ours->record_bytes : 0,
                             depth + 1))
          return error;
      }
    }
    if (stored_bytes_ > kMaxRecordBytes) return Error{"its table of fields is invalid"};
  }
  for (const Field& field : fields)
    if (std::ranges::find(found, field.name) == found.end()) missing_.emplace_back(field.name);
  return std::nullopt;
}

model::Result<Unpacker> Unpacker::make(const json& stored, FieldTable fields) {
  Unpacker out;
  if (auto error = out.add(stored, fields, 0, 0)) return *error;
  return out;
}

bool Unpacker::unpack(std::string_view bytes, void* record) const {
  if (bytes.size() != stored_bytes_) return false;
  char* const to = static_cast<char*>(record);
  for (const CopyStep& step : steps_) {
    std::memcpy(to + step.to_bytes, bytes.data() + step.from_bytes, step.size_bytes);
    if (!step.is_bool) continue;
    // A byte of a file may be neither 0 nor 1, which no bool may be.
    for (char& value : std::span(to + step.to_bytes, step.size_bytes))
      value = value == 0 ? '\0' : '\1';
  }
  return true;
}

}  // namespace tact::firmware::protocol
