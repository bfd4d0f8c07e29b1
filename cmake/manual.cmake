# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Manual pages, and completion of what is typed in bash, zsh and fish. The program prints them from its tables of options, so
# there are none where it cannot run here: cross-compiled without an emulator.
if(WIN32 OR (CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR))
  return()
endif()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/cli.md)
file(STRINGS docs/cli.md commands REGEX "^## ewa ") # which a test holds to the program
list(TRANSFORM commands REPLACE "^## ewa " "")
set(folder ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${folder})
set(pages ${folder}/ewa.1)
set(print COMMAND ewa --help-man > ${folder}/ewa.1)
foreach(command IN LISTS commands)
  list(APPEND pages ${folder}/ewa-${command}.1)
  list(APPEND print COMMAND ewa --help-man ${command} > ${folder}/ewa-${command}.1)
endforeach()
set(completions ${folder}/ewa ${folder}/_ewa ${folder}/ewa.fish)
add_custom_command(OUTPUT ${pages} ${completions} ${print}
  COMMAND ewa --completion bash > ${folder}/ewa
  COMMAND ewa --completion zsh > ${folder}/_ewa
  COMMAND ewa --completion fish > ${folder}/ewa.fish
  VERBATIM)
add_custom_target(manual ALL DEPENDS ${pages} ${completions})
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${folder}/ewa DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${folder}/_ewa DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${folder}/ewa.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
