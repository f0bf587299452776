# Run as a script at build time: writes OUTPUT, a C++ file that holds the files of FOLDER as bytes (page_files.h).
#   cmake -DFOLDER=... -DOUTPUT=... -P PageFiles.cmake
set(type_html text/html)
set(type_css text/css)
set(type_js text/javascript)
set(type_svg image/svg+xml)
file(GLOB files ${FOLDER}/*.html ${FOLDER}/*.css ${FOLDER}/*.js ${FOLDER}/*.svg)
list(SORT files)
set(arrays "")
set(cases "")
set(number 0)
foreach(path ${files})
  get_filename_component(name ${path} NAME)
  string(REGEX REPLACE ".*\\." "" extension ${name})
  set(type ${type_${extension}})
  file(READ ${path} bytes HEX)
  string(LENGTH "${bytes}" size)
  math(EXPR size "${size} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char kFile${number}[]{${bytes}};\n")
  string(APPEND cases "  if (name == \"${name}\") return PageFile{\"${type}\", {reinterpret_cast<const char*>(kFile${number}), ${size}}};\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made from daemon/serve/console/page by cmake/PageFiles.cmake.
#include \"daemon/serve/console/page_files.h\"

namespace mgtd::daemon::serve::console {
namespace {
${arrays}}  // namespace

std::optional<PageFile> page_file(std::string_view name) {
${cases}  return std::nullopt;
}

}  // namespace mgtd::daemon::serve::console
")
