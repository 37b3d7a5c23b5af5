// SPDX-License-Identifier: Apache-2.0
// access.h - who may look: decisions on the text of one HTTP request, nothing else.
//
// The files of the page are for everybody. What they show needs the random token printed at start,
// on loopback too: other users of this PC reach its loopback address. The token stands in the
// link's fragment, which no browser sends. The page hands it in once ("/session") and has it in a
// cookie from then on. On loopback the Host must also be a loopback name: a foreign page that
// points its own name at 127.0.0.1 is refused. WebSockets also need an Origin equal to the Host,
// which a foreign page cannot forge.
#pragma once

#include <string>
#include <string_view>

#include "model/result.h"

namespace tact::host::server {

struct Access {
  bool loopback = true;
  std::string bind_address;  // as in a URL
  std::string public_url{};  // of a proxy before it, "https://name:port"; empty: none
  std::string token;
  std::string cookie_name;  // one per port, because cookies do not know ports

  bool host_allowed(std::string_view host) const;
  /// By the header Authorization, "Bearer TOKEN", or by the header Cookie.
  bool token_allowed(std::string_view authorization, std::string_view cookies) const;
  /// What a browser keeps: for its own requests of this server, out of reach of scripts.
  std::string cookie() const;
};

/// "name:port" of "http://name:port/" or "https://name:port/"; empty if it is no such URL, or has
/// more: the page's files and its WebSocket stand at the top of their server.
std::string_view authority_of(std::string_view url);

/// "http://name:port" or "https://name:port" against "name:port".
bool origin_matches(std::string_view origin, std::string_view host);

/// Value of a key in "a=1&b=2", empty if absent.
std::string_view query_value(std::string_view query, std::string_view key);

/// 32 hex digits from the kernel's random numbers; Error: it gives none.
model::Result<std::string> make_token();

}  // namespace tact::host::server
