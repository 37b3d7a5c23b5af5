// SPDX-License-Identifier: Apache-2.0
// page_files.h - the page's files, read once into memory. A request is looked up by its exact path,
// so no path can name another file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "model/result.h"

namespace tact::host::server {

struct PageFile {
  std::string mime;
  std::string content;
};

class PageFiles {
 public:
  /// Reads every regular file below a folder. Error: what is wrong and what to do.
  std::optional<model::Error> load(const std::string& folder);

  /// "/" is index.html. nullptr if there is no such file.
  const PageFile* find(std::string_view path) const;

 private:
  std::map<std::string, PageFile, std::less<>> files_;  // by URL path, "/assets/page.js"
};

}  // namespace tact::host::server
