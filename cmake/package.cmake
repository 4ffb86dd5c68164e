# cmake --install and cpack -G DEB: the program alone, not the laboratory. It finds its sample relative to itself and holds
# shaders and fonts, so that the prefix is the user's choice at any time.
include(GNUInstallDirs)
set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(written ${PROJECT_BINARY_DIR}/packaging)  # by src/app and below

install(TARGETS splatcut RUNTIME)
install(FILES ${packaging}/splatcut.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${packaging}/splatcut.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
install(FILES ${packaging}/splatcut.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES ${written}/splatcut.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
install(FILES ${packaging}/splatcut.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME splatcut)
install(FILES assets/sample/sample.compressed.ply assets/sample/cameras.json DESTINATION ${CMAKE_INSTALL_DATADIR}/splatcut/sample)
install(FILES ${written}/copyright CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The licences of what is compiled in or embedded, as Debian words them; libraries bring their own.
file(READ LICENSE text)
set(held libcli11-dev libglm-dev libhwy-dev libnanoflann-dev nlohmann-json3-dev)
if(SPLATCUT_WINDOW)
  list(APPEND held libimgui-dev khronos-api python3-glad fonts-font-awesome fonts-roboto-unhinted)
endif()
foreach(package IN LISTS held)
  set(licence /usr/share/doc/${package}/copyright)
  if(EXISTS ${licence})
    file(READ ${licence} its_text)
    string(APPEND text "\n\n==== Holds parts of ${package}:\n\n${its_text}")
  else()
    message(WARNING "${licence} is missing: a package built here would lack the licence of what it holds. Install ${package} with its documentation.")
  endif()
endforeach()
file(CONFIGURE OUTPUT ${written}/copyright CONTENT "@text@" @ONLY)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME splatcut)
set(CPACK_PACKAGE_CONTACT "the splatcut authors <splatcut@example.org>" CACHE STRING "Maintainer, as the package names him")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})  # unless git knows better: package_version.cmake
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/package_version.cmake)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # OpenGL, which is opened while running, comes with libglfw3
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "zenity | kdialog")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "A click on an object gives its cutout, in a window or by command: no
training, no model weights, no GPU needed. Reads the files of the usual
trainers and viewers (ply, compressed.ply, splat, spz, sog, glb, ksplat) and
writes all of them but the last.")  # below the project's one line
include(CPack)
