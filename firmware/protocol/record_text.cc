// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/record_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <iterator>

#include "model/io/one_line.h"
#include "model/io/unit_name.h"

namespace tact::firmware::protocol {
namespace {

// Finer than view and plots; the tool's position is exact to 1 um at 1 m.
constexpr int kJsonDigits = 6;

std::size_t count_in(const Field& field, const ElementLimit& limit_of) {
  const auto most = limit_of ? limit_of(field) : std::nullopt;
  return std::min(field.count(), most.value_or(field.count()));
}

template <typename T>
T load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Calls `with` with the number at `from`, in its type.
template <typename With>
void visit(FieldType type, const char* from, const With& with) {
  switch (type) {
    case FieldType::kBool:
    case FieldType::kU8:
      return with(unsigned{load<std::uint8_t>(from)});
    case FieldType::kU16:
      return with(load<std::uint16_t>(from));
    case FieldType::kU32:
      return with(load<std::uint32_t>(from));
    case FieldType::kU64:
      return with(load<std::uint64_t>(from));
    case FieldType::kI16:
      return with(load<std::int16_t>(from));
    case FieldType::kI32:
      return with(load<std::int32_t>(from));
    case FieldType::kI64:
      return with(load<std::int64_t>(from));
    case FieldType::kF32:
      return with(load<float>(from));
    case FieldType::kF64:
      return with(load<double>(from));
    case FieldType::kRecord:
      return;
  }
}

std::uint64_t number_at(const Field& field, const char* from) {
  std::uint64_t number = 0;
  visit(field.type, from, [&number](auto value) { number = static_cast<std::uint64_t>(value); });
  return number;
}

void add_columns(std::string& out, const Field& field, const std::string& prefix,
                 const ElementLimit& limit_of) {
  const std::size_t count = count_in(field, limit_of);
  if (field.record != nullptr) {
    for (std::size_t i = 0; i < count; ++i)
      for (const Field& inner : field.record())
        add_columns(out, inner, fmt::format("{}{}{}_", prefix, field.name, i + 1), limit_of);
    return;
  }
  const std::string name = prefix + field.name;
  const auto to = std::back_inserter(out);
  if (field.shape[0] == 0) {
    fmt::format_to(to, ",{}", name);
    if (field.label != nullptr) fmt::format_to(to, ",{}_name", name);
    return;
  }
  const model::io::UnitName* const unit = model::io::find_unit(name);
  const std::string_view suffix = unit ? unit->suffix : std::string_view{};
  const std::string stem = name.substr(0, name.size() - suffix.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_named = i < field.components.size();
    fmt::format_to(to, ",{}_{}{}", stem, is_named ? field.components[i] : std::to_string(i),
                   suffix);
  }
}

void add_cells(std::string& out, const Field& field, const char* from,
               const ElementLimit& limit_of) {
  const std::size_t count = count_in(field, limit_of);
  if (field.record != nullptr) {
    for (std::size_t i = 0; i < count; ++i)
      for (const Field& inner : field.record())
        add_cells(out, inner, from + i * field.record_bytes + inner.offset_bytes, limit_of);
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
    visit(field.type, from + i * size_bytes_of(field.type),
          [&out](auto value) { fmt::format_to(std::back_inserter(out), ",{}", value); });
  if (field.label != nullptr) (out += ',') += field.label(number_at(field, from));
}

}  // namespace

std::string csv_facts(std::string_view title, const RunHeader& header) {
  using model::io::on_one_line;
  return fmt::format(
      "# {}\n# scene: {}\n# scene_hash: {}\n# law: {}\n# device: {}\n# revision: {}\n# began: {}\n"
      "# began_monotonic_s: {:.9f}\n# utc_max_error_us: {}\n# utc_error_us: {}\n# host: {}\n# "
      "rate_Hz: {:.10g}\n# frame_rate_Hz: {:.10g}\n",
      title, on_one_line(header.scene_name), on_one_line(header.scene_hash),
      on_one_line(header.law_name), on_one_line(header.device_name), on_one_line(header.revision),
      on_one_line(header.began_utc), 1e-9 * static_cast<double>(header.began_monotonic_ns),
      header.utc_max_error_us, header.utc_error_us, on_one_line(header.host_name), header.rate_Hz,
      header.frame_rate_Hz);
}

std::string csv_columns(FieldTable fields, const ElementLimit& limit_of) {
  std::string out;
  for (const Field& field : fields) add_columns(out, field, "", limit_of);
  return out.substr(1);
}

void append_csv(std::string& out, FieldTable fields, const void* record,
                const ElementLimit& limit_of) {
  const std::size_t start = out.size();
  const char* const bytes = static_cast<const char*>(record);
  for (const Field& field : fields) add_cells(out, field, bytes + field.offset_bytes, limit_of);
  out.erase(start, 1);  // the first comma
}

void append_json(std::string& out, FieldTable fields, const void* record,
                 const ElementLimit& limit_of) {
  const auto put = [&out](auto value) {
    if constexpr (!std::is_floating_point_v<decltype(value)>)
      fmt::format_to(std::back_inserter(out), "{}", value);
    else if (std::isfinite(value))
      fmt::format_to(std::back_inserter(out), "{:.{}g}", value, kJsonDigits);
    else
      out += "null";
  };
  const char* separator = "";
  for (const Field& field : fields) {
    if (field.record != nullptr) continue;
    const char* const from = static_cast<const char*>(record) + field.offset_bytes;
    fmt::format_to(std::back_inserter(out), "{}\"{}\":", std::exchange(separator, ","), field.name);
    if (field.shape[0] == 0) {
      if (field.type == FieldType::kBool)
        out += load<bool>(from) ? "true" : "false";
      else
        visit(field.type, from, put);
      continue;
    }
    out += '[';
    for (std::size_t i = 0; i < count_in(field, limit_of); ++i) {
      if (i > 0) out += ',';
      visit(field.type, from + i * size_bytes_of(field.type), put);
    }
    out += ']';
  }
}

}  // namespace tact::firmware::protocol
