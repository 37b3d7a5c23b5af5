// SPDX-License-Identifier: Apache-2.0
// record_text.h - records as rows of a CSV and as JSON, by the table of their fields.
//
// In a CSV a vector has a column for each component, with the unit last: tool_position_m is
// tool_position_x_m, ...; an enumeration has its number and, as NAME_name, its label. Numbers are
// the shortest decimals that read back to the same value.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/protocol/record_fields.h"
#include "firmware/protocol/run_header.h"

namespace tact::firmware::protocol {

/// Maximum number of elements of a field to write; empty: all.
using ElementLimit = std::function<std::optional<std::size_t>(const Field&)>;

/// What ran, in lines that begin with '#'; the first one has the title.
std::string csv_facts(std::string_view title, const RunHeader& header);

/// Names with commas between them. A record in a record has its name and number before its fields,
/// from 1 on: contact1_depth_m.
std::string csv_columns(FieldTable fields, const ElementLimit& limit_of = {});
void append_csv(std::string& out, FieldTable fields, const void* record,
                const ElementLimit& limit_of = {});

/// "name":value,... without records in records. Floats have six digits; what is not finite is null.
void append_json(std::string& out, FieldTable fields, const void* record,
                 const ElementLimit& limit_of = {});

}  // namespace tact::firmware::protocol
