# What the libraries link to; read by our own build and by find_package(vdbmap) alike.
# Ceres comes before OpenVDB: both define TBB targets, and only this order agrees.
find_package(Ceres REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(TBB REQUIRED CONFIG)
find_package(ZLIB REQUIRED)
find_package(meshoptimizer REQUIRED)

# OpenVDB ships a find module only, in a folder of its own; it leaves BUILD_SHARED_LIBS changed.
set(VDBMAP_SHARED_LIBS ${BUILD_SHARED_LIBS})
find_path(VDBMAP_OPENVDB_MODULE FindOpenVDB.cmake
  PATH_SUFFIXES cmake/OpenVDB ${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB
  PATHS /usr/lib /usr/lib64 /usr/local/lib NO_CACHE)
list(APPEND CMAKE_MODULE_PATH ${VDBMAP_OPENVDB_MODULE})
find_package(OpenVDB REQUIRED COMPONENTS openvdb)
list(REMOVE_ITEM CMAKE_MODULE_PATH ${VDBMAP_OPENVDB_MODULE})
set(BUILD_SHARED_LIBS ${VDBMAP_SHARED_LIBS})

find_package(PkgConfig REQUIRED)
pkg_check_modules(PCAP REQUIRED IMPORTED_TARGET libpcap)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(GMP REQUIRED IMPORTED_TARGET gmp)
