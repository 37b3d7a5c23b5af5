// SPDX-License-Identifier: Apache-2.0
// record_fields.h - a record's fields as a table: the one list from which its bytes, its CSV, its
// JSON, the page's types and the reader in Python are made.
//
// A record is packed field by field in the order of its table, little-endian, without padding. The
// table of the program that wrote a file is in the file (run_file.h), so a reader matches
// fields by name: missing fields keep their defaults, unknown fields are skipped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/result.h"
#include "model/types.h"

namespace tact::firmware::protocol {

enum class FieldType : std::uint8_t {
  kBool,
  kU8,
  kU16,
  kU32,
  kU64,
  kI16,
  kI32,
  kI64,
  kF32,
  kF64,
  kRecord  // of another table
};

struct Field;
using FieldTable = std::span<const Field>;

struct Field {
  const char* name;  // ends with the unit, if it has one
  FieldType type;
  std::array<std::size_t, 2> shape{};  // {}: one value; {n, 0}: n values; {n, m}: n rows of m
  std::size_t offset_bytes;            // in this program's struct
  const char* meaning;
  FieldTable (*record)() = nullptr;               // of kRecord
  std::size_t record_bytes = 0;                   // of kRecord: its struct
  std::span<const char* const> components{};      // of an array: x, y, z; empty: 0, 1, 2, ...
  const char* (*label)(std::uint64_t) = nullptr;  // of an enumeration; "unknown" beyond its values

  std::size_t count() const {
    return (shape[0] == 0 ? 1 : shape[0]) * (shape[1] == 0 ? 1 : shape[1]);
  }
  constexpr Field labelled(const char* (*names)(std::uint64_t)) const {
    Field out = *this;
    out.label = names;
    return out;
  }
  constexpr Field with_components(std::span<const char* const> names) const {
    Field out = *this;
    out.components = names;
    return out;
  }
};

inline constexpr std::array<const char*, 3> kXyz{"x", "y", "z"};
inline constexpr std::array<const char*, 4> kWxyz{"w", "x", "y", "z"};

/// Element type of a C++ type and how many there are.
template <typename T>
struct ArrayTraits {
  using type = T;
  static constexpr std::array<std::size_t, 2> kShape{};
};
template <typename T, std::size_t n>
struct ArrayTraits<T[n]> {
  using type = T;
  static constexpr std::array<std::size_t, 2> kShape{n, 0};
};
template <typename T, std::size_t n, std::size_t m>
struct ArrayTraits<T[n][m]> {
  using type = T;
  static constexpr std::array<std::size_t, 2> kShape{n, m};
};
template <typename T, std::size_t n>
struct ArrayTraits<std::array<T, n>> : ArrayTraits<T[n]> {};
template <>
struct ArrayTraits<model::Vec3> : ArrayTraits<double[3]> {};
template <>
struct ArrayTraits<model::Quat> : ArrayTraits<double[4]> {};
static_assert(sizeof(model::Vec3) == sizeof(double[3]) && sizeof(model::Quat) == sizeof(double[4]));

template <typename T>
constexpr FieldType field_type() {
  if constexpr (std::is_enum_v<T>) {
    return field_type<std::underlying_type_t<T>>();
  } else if constexpr (std::is_same_v<T, bool>) {
    return FieldType::kBool;
  } else if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? FieldType::kF32 : FieldType::kF64;
  } else if constexpr (std::is_class_v<T>) {
    return FieldType::kRecord;
  } else {
    static_assert(!std::is_same_v<T, std::int8_t>, "no record has one");
    constexpr bool kUnsigned = std::is_unsigned_v<T>;
    if (sizeof(T) == 1) return FieldType::kU8;
    if (sizeof(T) == 2) return kUnsigned ? FieldType::kU16 : FieldType::kI16;
    if (sizeof(T) == 4) return kUnsigned ? FieldType::kU32 : FieldType::kI32;
    return kUnsigned ? FieldType::kU64 : FieldType::kI64;
  }
}

/// Called by TACT_FIELD.
template <typename T>
constexpr Field make_field(const char* name, std::size_t offset_bytes, const char* meaning) {
  using Element = typename ArrayTraits<T>::type;
  Field out{.name = name,
            .type = field_type<Element>(),
            .shape = ArrayTraits<T>::kShape,
            .offset_bytes = offset_bytes,
            .meaning = meaning};
  if constexpr (std::is_class_v<Element>) {
    out.record = &Element::fields;
    out.record_bytes = sizeof(Element);
  }
  if (std::is_same_v<T, model::Quat>) out.components = kWxyz;
  if (out.shape[0] == kXyz.size() && out.shape[1] == 0) out.components = kXyz;
  return out;
}

/// One row of a table: member `path` of `Struct`, under `name`.
#define TACT_FIELD(Struct, path, name, meaning)                                   \
  ::tact::firmware::protocol::make_field<decltype(std::declval<Struct&>().path)>( \
      name, offsetof(Struct, path), meaning)

std::size_t size_bytes_of(FieldType type);  // of one element; 0 for kRecord

/// Appends the packed record.
void pack(FieldTable fields, const void* record, std::string& out);

/// The table as a file has it: a list of {name, type, shape, unit, meaning, values, fields}.
nlohmann::json json_of(FieldTable fields);

/// Unpacks records into this program's struct, by the table of the file.
class Unpacker {
 public:
  /// An error if the table is invalid, or a field has another type than here.
  static model::Result<Unpacker> make(const nlohmann::json& stored, FieldTable fields);
  /// Fields that this program has, and the file has not: they keep what they are.
  const std::vector<std::string>& missing() const { return missing_; }
  /// False if the bytes are not one record.
  bool unpack(std::string_view bytes, void* record) const;

 private:
  struct CopyStep {
    std::size_t from_bytes, to_bytes, size_bytes;
    bool is_bool;
  };
  /// Adds the steps of one record; `stored_bytes` grows by its size.
  std::optional<model::Error> add(const nlohmann::json& stored, FieldTable fields,
                                  std::size_t to_bytes, int depth);

  std::vector<CopyStep> steps_;
  std::vector<std::string> missing_;
  std::size_t stored_bytes_ = 0;
};

}  // namespace tact::firmware::protocol
