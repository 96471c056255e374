# Replaces the scripts by which CPack calls ldconfig in packages of libraries by the trigger that is in them already: Debian
# runs it once for all packages, and its checker warns of such scripts. CPack runs this on the packages it made.
find_program(DPKG_DEB_PROGRAM dpkg-deb REQUIRED)
foreach(package IN LISTS CPACK_PACKAGE_FILES)
  set(folder "${package}.content")
  file(REMOVE_RECURSE "${folder}")
  execute_process(COMMAND "${DPKG_DEB_PROGRAM}" --raw-extract "${package}" "${folder}" COMMAND_ERROR_IS_FATAL ANY)
  if(EXISTS "${folder}/DEBIAN/triggers")
    file(REMOVE "${folder}/DEBIAN/postinst" "${folder}/DEBIAN/postrm")
    execute_process(COMMAND "${DPKG_DEB_PROGRAM}" --root-owner-group -Zxz --build "${folder}" "${package}"
      OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  endif()
  file(REMOVE_RECURSE "${folder}")
endforeach()
