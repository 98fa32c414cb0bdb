# The files that `tessera package --arch` needs for another kind of processor, as a separate folder:
# lib/cmake/tessera with the toolchain, and the libraries.
include(CMakePackageConfigHelpers)
set(package_dir lib/cmake/tessera)
configure_package_config_file(cmake/tesseraConfig.cmake.in ${PROJECT_BINARY_DIR}/${package_dir}/tesseraConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/${package_dir}/tesseraConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
configure_file(${CMAKE_TOOLCHAIN_FILE} ${PROJECT_BINARY_DIR}/${package_dir}/toolchain.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/${package_dir}/tesseraConfig.cmake
              ${PROJECT_BINARY_DIR}/${package_dir}/tesseraConfigVersion.cmake
              ${PROJECT_BINARY_DIR}/${package_dir}/toolchain.cmake DESTINATION ${package_dir})
install(EXPORT tesseraTargets NAMESPACE tessera:: DESTINATION ${package_dir})
export(EXPORT tesseraTargets NAMESPACE tessera:: FILE ${PROJECT_BINARY_DIR}/${package_dir}/tesseraTargets.cmake)
