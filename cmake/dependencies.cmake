# Every third-party package, in one place; the rooms name the targets. All of them are Debian 12 packages
# (scripts/install-packages lists them by name).
find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
pkg_check_modules(geographiclib REQUIRED IMPORTED_TARGET geographiclib)
pkg_check_modules(netcdf REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(systemd REQUIRED IMPORTED_TARGET libsystemd)

# FLANN's C++ side is headers, which need LZ4; its pkg-config file would bring HDF5 and MPI along.
find_path(FLANN_INCLUDE_DIR flann/flann.hpp REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
add_library(flann_headers INTERFACE)
target_include_directories(flann_headers SYSTEM INTERFACE ${FLANN_INCLUDE_DIR})
target_link_libraries(flann_headers INTERFACE ${LZ4_LIBRARY})

# Debian's pkg-config file of ecCodes names an include directory that does not exist.
find_path(ECCODES_INCLUDE_DIR eccodes.h REQUIRED)
find_library(ECCODES_LIBRARY eccodes REQUIRED)
add_library(PkgConfig::eccodes INTERFACE IMPORTED GLOBAL)
target_include_directories(PkgConfig::eccodes SYSTEM INTERFACE ${ECCODES_INCLUDE_DIR})
target_link_libraries(PkgConfig::eccodes INTERFACE ${ECCODES_LIBRARY})
