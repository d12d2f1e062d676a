# Installs the core so that find_package(ebac CONFIG) gives ebac::ebac, wherever the prefix is moved to.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ebac)

install(TARGETS ebac EXPORT ebacTargets ARCHIVE COMPONENT core)
install(DIRECTORY cpp/ebac DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
        FILES_MATCHING PATTERN "*.hpp")
# What a law of your own needs to become a Python class; see examples/out_of_tree_law.
install(FILES "${EBAC_HEADERS_DIR}/ebac/headers.hpp" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ebac COMPONENT core)
install(FILES bindings/controllers.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ebac/python COMPONENT core)
install(EXPORT ebacTargets NAMESPACE ebac:: DESTINATION ${package_dir} COMPONENT core)

configure_package_config_file(cmake/ebacConfig.cmake.in ebacConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor release may break what the last one promised.
write_basic_package_version_file(ebacConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ebacConfig.cmake ${PROJECT_BINARY_DIR}/ebacConfigVersion.cmake
              cmake/EbacFindEigen.cmake
        DESTINATION ${package_dir} COMPONENT core)
