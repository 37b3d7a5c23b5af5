# SPDX-License-Identifier: Apache-2.0
# What a list of rooms declares: tact_room, tact_room_text, tact_program, tact_test.

# tact_room(ROOM [SOURCES a.cc part/b.cc...] [ALONE a.cc...] LINKS target... [MOSTLY_LIBRARY | LOOP])
# A folder as a library: the room model/law is the target tact_model_law, its SOURCES are in model/law/. LINKS names the
# rooms that it may include (tests/house/layering_test.py holds it to them) and the libraries that it uses. ALONE:
# those of SOURCES that no unity build takes up, as a test defines their functions in their place, or they define the
# heap's.
# MOSTLY_LIBRARY: more code of libraries' templates than computing. It is optimised less (-O1: host/server compiles
# in half the time), and not at all under a sanitizer.
# LOOP: computes in each tick. No bit changes: -O3 inlines and unrolls more, errno and traps alone are given up.
function(tact_room room)
  cmake_parse_arguments(ARG "MOSTLY_LIBRARY;LOOP" "" "SOURCES;ALONE;LINKS" ${ARGN})
  tact_target(target ${room})
  if(ARG_SOURCES)
    list(TRANSFORM ARG_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/${room}/)
    list(TRANSFORM ARG_ALONE PREPEND ${PROJECT_SOURCE_DIR}/${room}/)
    add_library(${target} STATIC ${ARG_SOURCES})
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_link_libraries(${target} PUBLIC tact_flags ${ARG_LINKS})
    if(ARG_MOSTLY_LIBRARY AND TACT_SANITIZE)
      target_compile_options(${target} PRIVATE -O0)
    elseif(ARG_MOSTLY_LIBRARY)
      target_compile_options(${target} PRIVATE -O1)
    endif()
    # Debian's hardening (dpkg-buildflags), for what reads the bytes of others and is in no tick.
    if(room MATCHES "^(host/|model/(io|reader)$|firmware/(console|protocol|telemetry)$)" AND PROJECT_IS_TOP_LEVEL
       AND NOT TACT_SANITIZE)
      target_compile_options(${target} PRIVATE
        "$<$<CONFIG:Release>:-fstack-protector-strong;-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
    endif()
    if(ARG_LOOP)
      target_compile_options(${target} PRIVATE -fno-math-errno -fno-trapping-math)
    endif()
    if(ARG_LOOP AND PROJECT_IS_TOP_LEVEL AND NOT TACT_SANITIZE)
      target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3;-g1>)
    endif()
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE tact_flags ${ARG_LINKS})
  endif()
endfunction()

function(tact_target variable room)  # the room firmware/black_box is the target tact_firmware_black_box
  string(REPLACE "/" "_" name ${room})
  set(${variable} tact_${name} PARENT_SCOPE)
endfunction()

# tact_room_text(tools/limits evidence/hazards.toml [NAME PATH]): the file of that room, or that of a path, as kText, or
# NAME, of "tools/limits/evidence/hazards.toml.h", in the room's namespace
function(tact_room_text folder file)
  string(REPLACE "/" "::" namespace ${folder})
  set(source ${PROJECT_SOURCE_DIR}/${folder}/${file})
  set(name kText)
  if(ARGC GREATER 2)
    set(name ${ARGV2})
    set(source ${ARGV3})
  endif()
  file(READ ${source} text)
  string(REPLACE "\"build/" "\"" text "${text}")  # of a command; who has installed tact has no such folder
  string(REPLACE "\"tests/" "\"" text "${text}")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/text/${folder}/${file}.h @ONLY CONTENT
    "// made from @folder@/@file@\n#pragma once\nnamespace tact::@namespace@ {\n\
inline constexpr const char* @name@ = R\"~~(@text@)~~\";\n}\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  tact_target(target ${folder})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/text)
endfunction()

# tact_program(NAME SOURCES main.cc... LINKS room... [OPTIMISED])
# Reading the command line is what takes longest to compile, so all programs share it parsed, and
# their own files are not optimised. OPTIMISED programs compute in files of their own, or run what is
# measured, which then shares no inline function with a file that is not.
file(CONFIGURE OUTPUT program_prelude.cc CONTENT "")
add_library(tact_program_base OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/program_prelude.cc)
target_link_libraries(tact_program_base PRIVATE tact_flags CLI11::CLI11 nlohmann_json::nlohmann_json)
target_precompile_headers(tact_program_base PRIVATE <CLI/CLI.hpp> <nlohmann/json.hpp>)
target_compile_options(tact_program_base PRIVATE -O0)
function(tact_program name)
  cmake_parse_arguments(ARG "OPTIMISED" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} CLI11::CLI11 nlohmann_json::nlohmann_json)
  target_link_options(${name} PRIVATE -Wl,-z,relro,-z,now)
  if(NOT ARG_OPTIMISED)
    target_precompile_headers(${name} REUSE_FROM tact_program_base)
    target_compile_options(${name} PRIVATE -O0)
  endif()
endfunction()

# Of the suites that wait for a real clock three run at a time: they get one of three locks in turn.
function(tact_next_clock clock)
  get_property(turn GLOBAL PROPERTY TACT_CLOCK)
  if(NOT turn)
    set(turn 0)
  endif()
  set(${clock} ${turn} PARENT_SCOPE)
  math(EXPR turn "(${turn} + 1) % 3")
  set_property(GLOBAL PROPERTY TACT_CLOCK ${turn})
endfunction()

# Such a test starts first, as it takes long and needs little of a core. Under a sanitizer nothing runs beside it.
foreach(clock 0 1 2)
  if(TACT_SANITIZE)
    set(TACT_REAL_CLOCK_${clock} RUN_SERIAL ON)
  else()
    set(TACT_REAL_CLOCK_${clock} RESOURCE_LOCK real_clock_${clock} COST 1000)
  endif()
endforeach()

# Test programs are linked by the quickest linker that is here: gold and lld take a third of the time of GNU's.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  foreach(linker gold lld)
    find_program(TACT_LD_${linker} ld.${linker})
    if(TACT_LD_${linker} AND NOT TACT_TEST_LINKER)
      set(TACT_TEST_LINKER -fuse-ld=${linker})
    endif()
  endforeach()
endif()

# tact_test(ROOM [SOURCES a_test.cc...] LINKS room... [PROGRAMS tactd...] [LABELS threads loop parse]
#           [REAL_CLOCK Suite...] [OPTIMISED a_test.cc...])
# All tests of a room as one program: the SOURCES in tests/model/law/ as model_law_test; where they name no a_test.cc,
# every one of that folder. PROGRAMS are run by it, so
# they are built with it; tests/support/program.h runs no other. LABELS: what tools/check runs again
# under the thread sanitizer (threads), the real-time sanitizer (loop: what a tick reaches) or that of
# addresses (parse: what reads files and bytes of others): ctest -L '[+]loop' finds those, -L model_law
# the room. REAL_CLOCK: suites that wait for a real clock.
# OPTIMISED: those of SOURCES that compute for seconds.
function(tact_test folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PROGRAMS;LABELS;REAL_CLOCK;OPTIMISED" ${ARGN})
  string(REPLACE "/" "_" room ${folder})
  set(test ${room}_test)
  if(NOT ARG_SOURCES MATCHES "_test\\.cc")
    file(GLOB tests RELATIVE ${PROJECT_SOURCE_DIR}/tests/${folder} CONFIGURE_DEPENDS
      ${PROJECT_SOURCE_DIR}/tests/${folder}/*_test.cc)
    list(APPEND ARG_SOURCES ${tests})
  endif()
  list(TRANSFORM ARG_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/tests/${folder}/)
  list(TRANSFORM ARG_OPTIMISED PREPEND ${PROJECT_SOURCE_DIR}/tests/${folder}/)
  add_executable(${test} ${ARG_SOURCES} $<TARGET_OBJECTS:tact_test_base>)
  target_link_libraries(${test} PRIVATE tact_flags ${ARG_LINKS} nlohmann_json::nlohmann_json GTest::gtest_main)
  target_precompile_headers(${test} REUSE_FROM tact_test_base)
  # The code under test is optimised; gtest's checks hold an if of their own.
  target_compile_options(${test} PRIVATE -O0 -Wno-dangling-else)
  target_link_options(${test} PRIVATE ${TACT_TEST_LINKER})
  list(JOIN ARG_PROGRAMS " " programs)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/tests/${test}.programs CONTENT "${programs}\n")  # for tools/checks/changed.sh
  target_compile_definitions(${test} PRIVATE TACT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             TACT_BINARY_DIR="${PROJECT_BINARY_DIR}"
                             TACT_PROGRAMS="${programs}")
  set_target_properties(${test} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests
                        UNITY_BUILD ${TACT_UNITY})
  if(ARG_PROGRAMS)
    add_dependencies(${test} ${ARG_PROGRAMS})
  endif()
  foreach(label ${ARG_LABELS})
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} ${test})
  endforeach()
  # Without the precompiled header, as that was not optimised.
  set_source_files_properties(${ARG_OPTIMISED} PROPERTIES COMPILE_OPTIONS -O1 SKIP_PRECOMPILE_HEADERS ON)
  foreach(suite ${ARG_REAL_CLOCK})
    tact_next_clock(clock)
    list(APPEND suites_${clock} ${suite}.*)
  endforeach()
  set(real_clock ${suites_0} ${suites_1} ${suites_2})
  list(JOIN real_clock ":" real_clock)
  list(TRANSFORM ARG_LABELS PREPEND "+")  # one word, as gtest_discover_tests takes no list
  list(JOIN ARG_LABELS "" labels)
  gtest_discover_tests(${test} DISCOVERY_TIMEOUT 60 TEST_FILTER "*-${real_clock}"
    PROPERTIES LABELS "${room}${labels}")
  foreach(clock 0 1 2)
    if(suites_${clock})
      list(JOIN suites_${clock} ":" filter)
      gtest_discover_tests(${test} DISCOVERY_TIMEOUT 60 TEST_FILTER "${filter}"
        PROPERTIES LABELS "${room}${labels}+clock" ${TACT_REAL_CLOCK_${clock}})
    endif()
  endforeach()
endfunction()
