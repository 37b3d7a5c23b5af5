// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/tick_csv.h"

#include "firmware/protocol/record_text.h"
#include "model/io/file_writer.h"

namespace tact::firmware::telemetry {

using protocol::LoggedTick;

std::string tick_csv_head(const protocol::RunHeader& header) {
  return protocol::csv_facts("tact ticks", header) +
         protocol::csv_columns(LoggedTick::fields(header.spheres.size())) + '\n';
}

std::string tick_csv_row(const LoggedTick& tick, std::size_t spheres) {
  std::string out;
  protocol::append_csv(out, LoggedTick::fields(spheres), &tick);
  return out + '\n';
}

model::Result<std::string> write_tick_csv(const std::string& log_path,
                                          const std::string& csv_path) {
  auto log = protocol::TickLog::open(log_path);
  if (!log) return log.error();
  const std::string head = tick_csv_head(log->header());
  // Only after the log was opened: an unreadable log leaves an older table unchanged.
  auto out = model::io::FileWriter::replace(csv_path, head);
  if (!out) return out.error();
  if (auto error = out->put(head)) return *error;
  // Damaged ticks are left out, so their numbers are missing in the first column.
  for (LoggedTick tick; log->next(tick);)
    if (auto error = out->put(tick_csv_row(tick, log->header().spheres.size()))) return *error;
  if (auto error = out->finish()) return *error;
  return log->damage();
}

}  // namespace tact::firmware::telemetry
