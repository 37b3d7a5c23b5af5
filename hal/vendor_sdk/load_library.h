// SPDX-License-Identifier: Apache-2.0
// load_library.h - a vendor SDK, loaded by name when a scene asks for it, and its functions.
//
// The library is proprietary and never part of tact: a device's room declares prototypes of its
// own. Unless the person trusts it, the file must be one of root's (library_trust.h). Once all
// functions are found it stays: a library with threads of its own cannot be unloaded safely.
#pragma once

#include <optional>
#include <string>

#include "model/result.h"

namespace tact::hal::vendor_sdk {

/// Whose it is, for the messages.
struct VendorSdk {
  const char* whose;    // "Force Dimension's"
  const char* source;   // "the SDK at forcedimension.com"
  const char* setting;  // "device.force_dimension.library"
  const char* file;     // "libdhd.so.3"
  const char* folder;   // where root may put it, "/opt/fd"
};

class LoadedLibrary {
 public:
  /// False when the library has no such symbol.
  template <typename Function>
  bool find(const char* symbol, Function& function) {
    void* found = address_of(symbol);
    function = reinterpret_cast<Function>(found);  // what POSIX promises of dlsym
    return found != nullptr;
  }
  /// As find, for a function without which the device cannot be driven.
  template <typename Function>
  void need(const char* symbol, Function& function) {
    if (!find(symbol, function) && missing_ == nullptr) missing_ = symbol;
  }
  /// The first needed function that is not there; the library is unloaded then.
  std::optional<model::Error> lacks();

 private:
  friend model::Result<LoadedLibrary> load_library(const std::string& name, bool trusted,
                                                   const VendorSdk& of);
  LoadedLibrary(void* library, std::string name, const VendorSdk& of)
      : handle_(library), name_(std::move(name)), of_(of) {}
  void* address_of(const char* symbol) const;

  void* handle_;
  std::string name_;
  VendorSdk of_;
  const char* missing_ = nullptr;
};

/// Loads the file of this name or path.
model::Result<LoadedLibrary> load_library(const std::string& name, bool trusted,
                                          const VendorSdk& of);

}  // namespace tact::hal::vendor_sdk
