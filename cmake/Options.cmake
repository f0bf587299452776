# Warnings are errors, sanitizers are chosen by preset, third-party headers are SYSTEM.
add_library(mgtd_options INTERFACE)
target_compile_options(mgtd_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wdouble-promotion -Werror -ffp-contract=off)
# False alarms of g++ 12 at -O3: a moved variant is taken for every alternative it could have held, and
# std::string's own insertion for an overlap (GCC bug 105651).
target_compile_options(mgtd_options INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-maybe-uninitialized>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-restrict>)
target_include_directories(mgtd_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_definitions(mgtd_options INTERFACE MGTD_VERSION="${PROJECT_VERSION}")

if(MGTD_SANITIZE)
  if(MGTD_SANITIZE MATCHES "thread" AND MGTD_SANITIZE MATCHES "address")
    message(FATAL_ERROR "address and thread sanitizers exclude each other")
  endif()
  target_compile_options(mgtd_options INTERFACE -fsanitize=${MGTD_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(mgtd_options INTERFACE -fsanitize=${MGTD_SANITIZE})
  if(MGTD_SANITIZE MATCHES "thread")
    target_compile_options(mgtd_options INTERFACE -Wno-tsan)
  endif()
endif()

# mgtd_room(NAME DIR [dependencies]): one static library per room from every source below it.
function(mgtd_room name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER sources EXCLUDE REGEX "main_[a-z_]+\\.cc$")
  list(FILTER sources EXCLUDE REGEX "/daemon/cli/")
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC mgtd_options ${ARGN})
endfunction()
