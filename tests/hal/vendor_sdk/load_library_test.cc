// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/load_library.h"

#include <gtest/gtest.h>

namespace tact::hal::vendor_sdk::load_library_test {

constexpr VendorSdk kVendor{.whose = "A vendor's",
                            .source = "the SDK at example.org",
                            .setting = "device.example.library",
                            .file = "libexample.so.1",
                            .folder = "/opt/example"};

TEST(LoadLibrary, FindsAFunctionInALibraryOfTheSystem) {
  auto library = load_library("libm.so.6", false, kVendor);
  ASSERT_TRUE(library) << library.error().message;
  double (*root)(double) = nullptr;
  library->need("sqrt", root);
  ASSERT_FALSE(library->lacks());
  EXPECT_EQ(root(9.0), 3.0);
}

TEST(LoadLibrary, FirstMissingRequiredFunctionIsNamed) {
  auto library = load_library("libm.so.6", false, kVendor);
  ASSERT_TRUE(library) << library.error().message;
  void (*none)() = nullptr;
  EXPECT_FALSE(library->find("exampleMayLack", none));
  EXPECT_FALSE(library->lacks());
  library->need("exampleOpen", none);
  library->need("exampleClose", none);
  EXPECT_EQ(none, nullptr);
  const auto error = library->lacks();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message,
            "libm.so.6 has no function exampleOpen, so it is not A vendor's library or too old a "
            "one; let device.example.library name libexample.so.1 of a current SDK");
}

TEST(LoadLibrary, AMissingLibraryIsReportedWithItsSource) {
  const auto library = load_library("libexample.so.1", false, kVendor);
  ASSERT_FALSE(library);
  for (const char* part : {"libexample.so.1: in no system folder", "the SDK at example.org",
                           "let device.example.library name its libexample.so.1 by path"})
    EXPECT_NE(library.error().message.find(part), std::string::npos) << library.error().message;
}

TEST(LoadLibrary, AFileOfAnybodyNeedsATrustingPerson) {
  const std::string file = testing::TempDir() + "tact-anybodys-library";
  std::ofstream(file) << "no library";
  const auto refused = load_library(file, false, kVendor);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("sudo install -D -o root -m 644 libexample.so.1 "
                                         "/opt/example/libexample.so.1"),
            std::string::npos)
      << refused.error().message;
  const auto trusted = load_library(file, true, kVendor);
  ASSERT_FALSE(trusted);
  EXPECT_NE(trusted.error().message.find("library cannot be loaded"), std::string::npos);
  std::filesystem::remove(file);
}

}  // namespace tact::hal::vendor_sdk::load_library_test
