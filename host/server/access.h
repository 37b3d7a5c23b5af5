// SPDX-License-Identifier: Apache-2.0
// access.h - who may look: decisions on the text of one HTTP request, nothing else.
//
// On a loopback address every local user may look, but only by a loopback name (a foreign web page
// that points its own name at 127.0.0.1 is refused). On any other address the URL must carry the
// random token printed at start; the page then keeps it in a cookie for its own files.
// WebSockets also need an Origin equal to the Host, which a foreign page cannot forge.
#pragma once

#include <string>
#include <string_view>

#include "model/result.h"

namespace tact::host::server {

struct Access {
  bool loopback = true;
  std::string bind_address;  // as in a URL
  std::string token;         // empty on loopback
  std::string cookie_name;   // one per port, because cookies do not know ports

  bool host_allowed(std::string_view host) const;
  /// By the URL's query or by the cookie header.
  bool token_allowed(std::string_view query, std::string_view cookies) const;
};

/// "http://name:port" or "https://name:port" against "name:port".
bool origin_matches(std::string_view origin, std::string_view host);

/// Value of a key in "a=1&b=2", empty if absent.
std::string_view query_value(std::string_view query, std::string_view key);

/// 32 hex digits from the kernel's random numbers; Error: it gives none.
model::Result<std::string> make_token();

}  // namespace tact::host::server
