# SPDX-License-Identifier: Apache-2.0
# tact::controller, for other programs: laws, contact, gate, controller and scenes as one static library. They take it
# by add_subdirectory or, once installed, by find_package(tact); tools/examples/README.md says how.

# Its public headers. What these include is installed with them, but may change with every version.
set(public_headers
  firmware/embed/haptics.h firmware/loop/controller.h hal/device.h model/contact/contact.h
  model/indent/hunt_crossley.h model/law/law.h model/mesh/mesh.h model/scene/scene.h model/scene/tissue.h
  model/tissue/elastic_field.h)

add_library(tact_controller STATIC)
add_library(tact::controller ALIAS tact_controller)
foreach(room model model_law model_indent model_contact model_tissue model_springs model_io model_mesh model_reader
    model_scene hal firmware_gate firmware_loop firmware_embed)
  target_sources(tact_controller PRIVATE $<TARGET_OBJECTS:tact_${room}>)
endforeach()
set_target_properties(tact_controller PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME controller OUTPUT_NAME tact)
target_compile_features(tact_controller INTERFACE cxx_std_20)
target_include_directories(tact_controller INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tact>)
target_link_libraries(tact_controller PRIVATE fmt::fmt OpenSSL::Crypto tomlplusplus::tomlplusplus)

if(PROJECT_IS_TOP_LEVEL)  # the package tact-dev
  include(CMakePackageConfigHelpers)
  set(config ${CMAKE_INSTALL_LIBDIR}/cmake/tact)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/tactConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/tactConfig.cmake ${PROJECT_BINARY_DIR}/tactConfigVersion.cmake
    DESTINATION ${config} COMPONENT development)
  install(TARGETS tact_controller EXPORT tact ARCHIVE COMPONENT development)
  install(EXPORT tact NAMESPACE tact:: DESTINATION ${config} FILE tactTargets.cmake COMPONENT development)
  install(CODE "set(source ${PROJECT_SOURCE_DIR})
    set(headers ${public_headers})
    set(include ${CMAKE_INSTALL_INCLUDEDIR}/tact)" COMPONENT development)
  install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/install_headers.cmake COMPONENT development)
endif()
