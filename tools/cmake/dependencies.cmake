# SPDX-License-Identifier: Apache-2.0
# What tact is built with: Debian packages, as tools/packages.sh installs them.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(Boost CONFIG REQUIRED)
find_package(OpenSSL REQUIRED)
if(TACT_PROGRAMS)
  find_library(GPIOD gpiod REQUIRED)  # Debian's libgpiod has no CMake file
  find_path(GPIOD_INCLUDE_DIR gpiod.h REQUIRED)
  find_library(LIBUSB usb-1.0 REQUIRED)  # nor has Debian's libusb
  find_library(SECCOMP seccomp REQUIRED)
endif()
if(TACT_TOOLS AND NOT TACT_VIEW)
  message(FATAL_ERROR "TACT_TOOLS needs the viewer's tracking: -DTACT_VIEW=ON, or -DTACT_TOOLS=OFF too")
endif()
if(TACT_VIEW)
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  find_path(OPENCV_INCLUDE_DIR opencv2/calib3d.hpp PATH_SUFFIXES opencv4)
  find_library(OPENCV_CALIB3D opencv_calib3d)  # Debian's calib3d package has no CMake file
  find_library(OPENCV_CORE opencv_core)
  if(NOT (OPENCV_INCLUDE_DIR AND OPENCV_CALIB3D AND OPENCV_CORE))
    message(FATAL_ERROR "tact-view needs OpenCV: apt-get install libopencv-core-dev "
      "libopencv-calib3d-dev; for the controller alone: -DTACT_VIEW=OFF -DTACT_TOOLS=OFF")
  endif()
endif()
if(TACT_LAB)
  find_package(benchmark REQUIRED)
endif()
if(BUILD_TESTING AND TACT_PROGRAMS)
  find_package(GTest REQUIRED)
  find_library(OPENIGTLINK OpenIGTLink)  # a peer of tests; without it those are left out
  find_path(OPENIGTLINK_INCLUDE_DIR igtlClientSocket.h PATH_SUFFIXES openigtlink)
  include(GoogleTest)
endif()
