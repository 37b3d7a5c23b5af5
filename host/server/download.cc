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

constexpr std::size_t kFramesPerPart = 256;

}  // namespace

Download::Download(beast::tcp_stream stream, std::shared_ptr<const record::Recording> recording,
                   DownloadKind kind)
    : stream_(std::move(stream)),
      recording_(std::move(recording)),
      kind_(kind),
      bodies_(bodies_in(*recording_)) {}

void Download::start(Header header) {
  header_ = std::move(header);
  stream_.expires_after(kPatience);
  http::async_write_header(stream_, serializer_,
                           [self = shared_from_this()](error_code wrong, std::size_t) {
                             if (!wrong) self->write_chunk(self->first_part());
                           });
}

std::string Download::first_part() const {
  if (kind_ == DownloadKind::kCsv) return record::csv_header(recording_->hello, bodies_);
  return recording_start(
      recording_->hello, recording_->mesh,
      recording_->operators.empty() ? record::kRecordingVersion : record::kTrackedRecordingVersion);
}

void Download::write_chunk(std::string part) {
  seal_.add(part);
  part_ = std::move(part);
  stream_.expires_after(kPatience);
  boost::asio::async_write(stream_, http::make_chunk(boost::asio::buffer(part_)),
                           [self = shared_from_this()](error_code wrong, std::size_t) {
                             if (!wrong) self->write_next();
                           });
}

void Download::write_next() {
  const std::vector<record::Frame>& frames = recording_->frames;
  if (next_ == frames.size()) {
    if (kind_ == DownloadKind::kCsv || std::exchange(is_sealed_, true)) return finish();
    return write_chunk(seal_.bytes());
  }
  std::string part;
  const std::size_t end = std::min(next_ + kFramesPerPart, frames.size());
  for (; next_ < end; ++next_) {
    const tracking::TrackedOperator* tracked = recording_->operator_at(next_);
    if (kind_ == DownloadKind::kCsv) {
      record::append_csv_row(part, frames[next_], recording_->hello, tracked, bodies_);
    } else {
      part += recording_frame(frames[next_]);
      if (tracked != nullptr)
        part += record::operator_record(*tracked, recording_->figure_at(next_));
    }
  }
  write_chunk(std::move(part));
}

void Download::finish() {
  boost::asio::async_write(
      stream_, http::make_chunk_last(), [self = shared_from_this()](error_code, std::size_t) {
        error_code ignored;
        self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
      });
}

}  // namespace tact::host::server
