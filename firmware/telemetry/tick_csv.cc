// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/tick_csv.h"

#include <fmt/format.h>

#include "firmware/protocol/record_text.h"
#include "model/io/file_writer.h"
#include "model/io/one_line.h"

namespace tact::firmware::telemetry {

using protocol::LoggedTick;

std::string tick_csv_head(const protocol::RunHeader& header) {
  using model::io::on_one_line;
  return fmt::format(
      "# tact ticks\n# scene: {}\n# scene_hash: {}\n# law: {}\n# revision: {}\n# began: {}\n"
      "# host: {}\n# rate_Hz: {:.10g}\n{}\n",
      on_one_line(header.scene_name), on_one_line(header.scene_hash), on_one_line(header.law_name),
      on_one_line(header.revision), on_one_line(header.began_utc), on_one_line(header.host_name),
      header.rate_Hz, protocol::csv_columns(LoggedTick::fields()));
}

std::string tick_csv_row(const LoggedTick& tick) {
  std::string out;
  protocol::append_csv(out, LoggedTick::fields(), &tick);
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
    if (auto error = out->put(tick_csv_row(tick))) return *error;
  if (auto error = out->finish()) return *error;
  return log->damage();
}

}  // namespace tact::firmware::telemetry
