include(CMakePackageConfigHelpers)

set(VDBMAP_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vdbmap)

install(TARGETS vdbmap vdbmap_registration vdbmap_parking EXPORT vdbmapTargets)
install(EXPORT vdbmapTargets NAMESPACE vdbmap:: DESTINATION ${VDBMAP_CONFIG_DIR})
install(DIRECTORY vdbmap registration parking DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/vdbmapConfig.cmake.in
  ${PROJECT_BINARY_DIR}/vdbmapConfig.cmake INSTALL_DESTINATION ${VDBMAP_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vdbmapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vdbmapConfig.cmake ${PROJECT_BINARY_DIR}/vdbmapConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/VdbmapDependencies.cmake DESTINATION ${VDBMAP_CONFIG_DIR})
