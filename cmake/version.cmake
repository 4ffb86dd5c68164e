# splatcut_version(OUT FALLBACK): the nearest tag of git, v1.2.0 as 1.2.0 and twelve commits later as 1.2.0+12.gabcdef0; without
# git or a tag, FALLBACK. The program's own sources alone count: a git above an unpacked archive says nothing of it.
# As a script (cmake -D OUTPUT=... -D FALLBACK=... -P): writes the C++ source of version(), where that changed.
cmake_policy(VERSION 3.25)
function(splatcut_version out fallback)
  set(${out} ${fallback} PARENT_SCOPE)
  get_filename_component(source ${CMAKE_CURRENT_FUNCTION_LIST_DIR} DIRECTORY)
  find_program(GIT git)
  if(NOT GIT OR NOT EXISTS ${source}/.git)
    return()
  endif()
  execute_process(COMMAND ${GIT} -C ${source} describe --tags --match "v[0-9]*" OUTPUT_VARIABLE tag OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(tag MATCHES "^v([0-9.]+)(-([0-9]+)-(g[0-9a-f]+))?$")
    set(version ${CMAKE_MATCH_1})
    if(CMAKE_MATCH_2)
      string(APPEND version "+${CMAKE_MATCH_3}.${CMAKE_MATCH_4}")
    endif()
    set(${out} ${version} PARENT_SCOPE)
  endif()
endfunction()

if(DEFINED OUTPUT)
  splatcut_version(version ${FALLBACK})
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
    "#include \"app/console/version.h\"\n\nconst char* splatcut::version() {\n  return \"@version@\";\n}\n" @ONLY)
endif()
