# Read by cpack while it packs: the version that the program was built with.
include(${CMAKE_CURRENT_LIST_DIR}/version.cmake)
splatcut_version(CPACK_PACKAGE_VERSION ${CPACK_PACKAGE_VERSION})
