// SPDX-License-Identifier: Apache-2.0
#include "host/server/download.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <utility>

#include "host/record/operator_record.h"
#include "host/record/recording_csv.h"

namespace tact::host::server {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using beast::error_code;

// Some hundred rows per turn; live frames of other browsers are sent in between.
constexpr std::size_t kFramesPerPart = 256;

}  // namespace

Download::Download(beast::tcp_stream stream, ConnectionSlot slot, record::Snapshot snapshot,
                   DownloadKind kind)
    : stream_(std::move(stream)),
      slot_(std::move(slot)),
      snapshot_(std::move(snapshot)),
      kind_(kind),
      deadline_(std::chrono::steady_clock::now() + kLongestDownload),
      bodies_(bodies_in(snapshot_)) {}

void Download::wait_at_most(std::chrono::seconds timeout) {
  // Two limits: 30 s per part, five minutes in total.
  stream_.expires_at(std::min(deadline_, std::chrono::steady_clock::now() + timeout));
}

void Download::start(Header header) {
  header_ = std::move(header);
  wait_at_most(kTimeout);
  http::async_write_header(stream_, serializer_,
                           [self = shared_from_this()](error_code wrong, std::size_t) {
                             if (!wrong) self->write_chunk(self->first_part());
                           });
}

std::string Download::first_part() const {
  if (kind_ == DownloadKind::kCsv)
    return record::csv_facts(snapshot_.header) + record::csv_header(snapshot_.header, bodies_);
  return record::start_of_recording(snapshot_.header, *snapshot_.mesh);
}

void Download::write_chunk(std::string part) {
  seal_.add(part);
  part_ = std::move(part);
  wait_at_most(kTimeout);
  boost::asio::async_write(stream_, http::make_chunk(boost::asio::buffer(part_)),
                           [self = shared_from_this()](error_code wrong, std::size_t) {
                             if (!wrong) self->write_next();
                           });
}

void Download::write_next() {
  const auto& frames = snapshot_.frames;
  if (next_ == frames.size()) {
    // The seal goes last: it distinguishes a complete recording from a truncated one.
    if (kind_ == DownloadKind::kCsv || std::exchange(is_sealed_, true)) return finish();
    return write_chunk(seal_.bytes());
  }
  std::string part;
  const std::size_t end = std::min(next_ + kFramesPerPart, frames.size());
  for (; next_ < end; ++next_) {
    const record::KeptFrame& kept = *frames[next_];
    const record::KeptOperator* const person = kept.person.get();
    if (kind_ == DownloadKind::kCsv) {
      record::append_csv_row(part, kept.frame, snapshot_.header,
                             person != nullptr ? &person->tracked : nullptr, bodies_);
      continue;
    }
    part += chunk_of(kept.frame, record::Frame::fields(snapshot_.header.spheres.size()));
    if (person != nullptr)
      part += record::operator_chunk(person->tracked, person->figure ? &*person->figure : nullptr);
  }
  write_chunk(std::move(part));
}

void Download::finish() {
  boost::asio::async_write(
      stream_, http::make_chunk_last(), [self = shared_from_this()](error_code, std::size_t) {
        error_code ignored;
        // Ends the stream, so that the browser does not wait for more.
        self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
      });
}

}  // namespace tact::host::server
