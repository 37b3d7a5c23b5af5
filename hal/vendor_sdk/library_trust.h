// SPDX-License-Identifier: Apache-2.0
// library_trust.h - which file may be loaded as a vendor SDK.
//
// A scene names it, and a scene may come from anybody; what is loaded runs with all that tactd may
// do. So the file, and every folder on its way, belongs to root and is written by no other user,
// and it lies where software is installed. A name without a path is looked for in the
// system's folders alone, independent of LD_LIBRARY_PATH; where the libraries that it needs itself
// are found is the loader's matter, and that variable counts there. --trust-library leaves all of
// this out.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::hal::vendor_sdk {

/// Where it may lie, and whose it must be; a test has others.
struct LibraryFolders {
  std::vector<std::string> searched;  // for a name without a path, in this order
  std::vector<std::string> allowed;   // it lies below one of these, links followed
  std::string top = "/";              // of what must belong to the owner
  uid_t owner = 0;
};
LibraryFolders system_folders();

/// The whole path of the file of this name or path, links followed. An error: it is not there.
model::Result<std::string> find_library(const std::string& name,
                                        const LibraryFolders& folders = system_folders());

/// Why this file, by its whole path, is not loaded: the first part of the path that may not be
/// trusted, with owner, mode and this remedy.
std::optional<model::Error> distrust_library(const std::string& file, const std::string& remedy,
                                             const LibraryFolders& folders = system_folders());

}  // namespace tact::hal::vendor_sdk
