# Debian 12 packages; the list that installs them is .ci/packages.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tl-expected REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(Boost 1.74 REQUIRED)
pkg_check_modules(serialport REQUIRED IMPORTED_TARGET libserialport)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(systemd REQUIRED IMPORTED_TARGET libsystemd)

add_library(mgtd_asio INTERFACE)
target_link_libraries(mgtd_asio INTERFACE Boost::headers Threads::Threads)
target_compile_definitions(mgtd_asio INTERFACE BOOST_ASIO_SEPARATE_COMPILATION BOOST_ASIO_NO_DEPRECATED
  BOOST_ERROR_CODE_HEADER_ONLY)

add_library(mgtd_eigen INTERFACE)
target_link_libraries(mgtd_eigen INTERFACE Eigen3::Eigen)
target_compile_definitions(mgtd_eigen INTERFACE EIGEN_MPL2_ONLY)
