# What cmake/version.cmake says of a folder without git, a git without a tag, a tag, a commit after it.
# Usage: cmake -D SOURCE=... -D FOLDER=... -P
file(REMOVE_RECURSE ${FOLDER})
file(COPY ${SOURCE}/cmake/version.cmake DESTINATION ${FOLDER}/cmake)
include(${FOLDER}/cmake/version.cmake)
find_program(GIT git)

function(expect pattern)
  splatcut_version(version 0.1.0)
  if(NOT version MATCHES "^${pattern}$")
    message(FATAL_ERROR "The version is ${version}, expected ${pattern}")
  endif()
endfunction()

function(git)
  execute_process(COMMAND ${GIT} -c user.name=t -c user.email=t@example.org ${ARGN} WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()

expect("0\\.1\\.0")  # the git around it, if any, is another program's
if(NOT GIT)
  message("skipped: git is not installed")
  return()
endif()
git(init -q)
git(commit -q --allow-empty -m one)
expect("0\\.1\\.0")
git(tag demo)
expect("0\\.1\\.0")
git(tag v1.2.0)
expect("1\\.2\\.0")
git(commit -q --allow-empty -m two)
expect("1\\.2\\.0\\+1\\.g[0-9a-f]+")
