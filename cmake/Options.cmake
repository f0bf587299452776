# Warnings are errors unless MGTD_WERROR is off, sanitizers are chosen by preset, third-party headers are SYSTEM.
add_library(mgtd_options INTERFACE)
target_compile_options(mgtd_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wdouble-promotion $<$<BOOL:${MGTD_WERROR}>:-Werror> -ffp-contract=off)
# False alarms of g++ 12 at -O3 and under a sanitizer: a moved variant is taken for every alternative it could have
# held, and so are the states of std::regex; at -O3 also std::string's own insertion for an overlap (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND (MGTD_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Release"))
  target_compile_options(mgtd_options INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
# g++ collects its garbage again and again while it instantiates Eigen; with room to grow it needs a tenth less time
# and a fifth more memory (docs/building.md).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(mgtd_options INTERFACE "SHELL:--param ggc-min-expand=300" "SHELL:--param ggc-min-heapsize=400000")
endif()
target_include_directories(mgtd_options INTERFACE ${CMAKE_SOURCE_DIR})

if(MGTD_SANITIZE)
  if(MGTD_SANITIZE MATCHES "thread" AND MGTD_SANITIZE MATCHES "address")
    message(FATAL_ERROR "address and thread sanitizers exclude each other")
  endif()
  target_compile_options(mgtd_options INTERFACE -fsanitize=${MGTD_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(mgtd_options INTERFACE -fsanitize=${MGTD_SANITIZE})
  # Eigen's templates pass pointers and references at every step, and checks of each keep the compiler from inlining
  # them: four times the time (docs/building.md). They stand where bytes become values; AddressSanitizer sees a null
  # pointer and an object that is overrun everywhere.
  if(MGTD_SANITIZE MATCHES "undefined" AND NOT MGTD_FUZZ)
    target_compile_options(mgtd_options INTERFACE
      $<$<NOT:$<BOOL:$<TARGET_PROPERTY:MGTD_EVERY_CHECK>>>:-fno-sanitize=null,alignment,object-size,vptr,pointer-overflow>)
  endif()
  # Each compiler has a macro of its own for it.
  target_compile_definitions(mgtd_options INTERFACE MGTD_SANITIZED)
  if(MGTD_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(mgtd_options INTERFACE -Wno-tsan)
  endif()
endif()

# mgtd_batches(TARGET SIZE [BY_FOLDER]): its sources are compiled in batches of that many files (jumbo or unity build):
# headers and templates that they share are read and instantiated once for a batch. docs/building.md. BY_FOLDER: no batch
# has files of two folders, for those may give one name to two things.
function(mgtd_batches target size)
  if(NOT MGTD_BATCHES)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 2 batches "BY_FOLDER" "" "")
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    set(group all)
    if(batches_BY_FOLDER)
      get_filename_component(folder ${source} DIRECTORY)
      file(RELATIVE_PATH folder ${CMAKE_CURRENT_SOURCE_DIR} ${folder})
      string(MAKE_C_IDENTIFIER "in_${folder}" group)
    endif()
    math(EXPR number "0${count_${group}} + 1")
    set(count_${group} ${number})
    math(EXPR batch "(${number} - 1) / ${size}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${batch})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# mgtd_unoptimised(TARGET), mgtd_unoptimised_source(FILE): clang compiles files in about half the time where it does not
# optimise them. For what does not compute for long, in the presets of everyday work (docs/building.md).
set(mgtd_O0 $<$<AND:$<CONFIG:Debug>,$<CXX_COMPILER_ID:Clang>>:-O0>)
function(mgtd_unoptimised target)
  target_compile_options(${target} PRIVATE ${mgtd_O0})
endfunction()
function(mgtd_unoptimised_source source)
  set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS ${mgtd_O0})
endfunction()

# mgtd_room(NAME [WITHOUT FOLDER] [dependencies]): one static library per room from every source below it, but for those
# of one folder.
function(mgtd_room name)
  cmake_parse_arguments(PARSE_ARGV 1 room "" "WITHOUT" "")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER sources EXCLUDE REGEX "main_[a-z_]+\\.cc$")
  if(room_WITHOUT)
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${room_WITHOUT}/")
  endif()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC mgtd_options ${room_UNPARSED_ARGUMENTS})
  mgtd_batches(${name} ${MGTD_BATCH_SIZE})
endfunction()
