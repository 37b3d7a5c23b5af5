// SPDX-License-Identifier: Apache-2.0
// download.h - sends the kept frames as a file, a few hundred at a time, so that a long file does
// not delay the live frames of other browsers. All downloads share their frames with the view
// (record::Snapshot). A download is aborted after five minutes, so that old frames do not
// accumulate.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/serializer.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "host/record/recording.h"
#include "host/server/connection_slot.h"
#include "model/io/seal.h"

namespace tact::host::server {

constexpr std::chrono::seconds kTimeout{30};           // for one part, if the browser does not read
constexpr std::chrono::seconds kLongestDownload{300};  // in total, if it reads slowly

enum class DownloadKind { kCsv, kRecording };

class Download : public std::enable_shared_from_this<Download> {
 public:
  using Header = boost::beast::http::response<boost::beast::http::empty_body>;

  Download(boost::beast::tcp_stream stream, ConnectionSlot slot, record::Snapshot snapshot,
           DownloadKind kind);

  /// Header must be chunked. The connection closes at the end.
  void start(Header header);

 private:
  std::string first_part() const;
  void write_chunk(std::string part);
  void write_next();
  void finish();

  void wait_at_most(std::chrono::seconds timeout);

  boost::beast::tcp_stream stream_;
  ConnectionSlot slot_;
  record::Snapshot snapshot_;
  DownloadKind kind_;
  std::chrono::steady_clock::time_point deadline_;
  std::vector<tracking::BodyRole> bodies_;
  Header header_;
  boost::beast::http::response_serializer<boost::beast::http::empty_body> serializer_{header_};
  std::string part_;
  std::size_t next_ = 0;
  model::io::Seal seal_;  // over the recording sent so far
  bool is_sealed_ = false;
};

}  // namespace tact::host::server
