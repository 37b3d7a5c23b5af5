// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/tick_csv.h"

#include "firmware/protocol/record_text.h"
#include "model/io/file_writer.h"

namespace tact::firmware::telemetry {

using protocol::LoggedTick;

model::Result<std::string> write_tick_csv(const std::string& log_path,
                                          const std::string& csv_path) {
  auto log = protocol::TickLog::open(log_path);
  if (!log) return log.error();
  const protocol::FieldTable fields = LoggedTick::fields(log->header().spheres.size());
  const std::string head =
      protocol::csv_facts("tact ticks", log->header()) + protocol::csv_columns(fields) + '\n';
  // Only after the log was opened: an unreadable log leaves an older table unchanged.
  auto out = model::io::FileWriter::replace(csv_path, head);
  if (!out) return out.error();
  if (auto error = out->put(head)) return *error;
  // Damaged ticks are left out, so their numbers are missing in the first column.
  for (LoggedTick tick; log->next(tick);) {
    std::string row;
    protocol::append_csv(row, fields, &tick);
    if (auto error = out->put(row += '\n')) return *error;
  }
  if (auto error = out->finish()) return *error;
  return log->damage();
}

}  // namespace tact::firmware::telemetry
