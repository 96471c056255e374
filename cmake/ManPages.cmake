# install_man_pages(<target> <component> <file>...): builds manual pages, which other commands make, with everything else, and
# installs them; for packages compressed and without a time, as Debian wants them.
function(install_man_pages target component)
  set(pages ${ARGN})
  if(PCL_COSECTION_BUILD_PACKAGES)
    foreach(page IN LISTS ARGN)
      add_custom_command(OUTPUT "${page}.gz"
        COMMAND gzip -9 --no-name --force --keep "${page}"
        DEPENDS "${page}"
        VERBATIM)
    endforeach()
    list(TRANSFORM pages APPEND ".gz")
  endif()
  add_custom_target(${target} ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT ${component})
endfunction()
