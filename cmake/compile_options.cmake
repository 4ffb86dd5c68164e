# One interface target carries the flags of every target of ours.
#   -ffp-contract=off   a*b+c is fused only where the code says so: same bits on every machine
#   -fmacro-prefix-map  asserts name their file from the project's folder, not from the builder's root
#   -fno-math-errno, -fno-trapping-math   let sqrt and comparisons vectorise; no result changes
add_library(splatcut_options INTERFACE)
target_compile_options(splatcut_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers -Wno-psabi
  -ffp-contract=off -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/= -fno-math-errno -fno-trapping-math)
if(SPLATCUT_SANITIZE)
  target_compile_options(splatcut_options INTERFACE -fno-omit-frame-pointer
    "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:SPLATCUT_NOT_SANITIZED>>>:-fsanitize=${SPLATCUT_SANITIZE};-fno-sanitize-recover=all>")
  target_link_options(splatcut_options INTERFACE -fsanitize=${SPLATCUT_SANITIZE})
endif()
if(SPLATCUT_SANITIZE AND NOT SPLATCUT_SANITIZE_LOOPS)
  # Programs take the first of equal templates: TBB's ends of loops as the sanitizer sees them, not those of a release.
  add_library(ends_of_loops OBJECT tests/ends_of_loops.cpp)
  target_compile_options(ends_of_loops PRIVATE -fsanitize=${SPLATCUT_SANITIZE})
  target_link_options(splatcut_options INTERFACE $<TARGET_OBJECTS:ends_of_loops>)
  add_dependencies(splatcut_options ends_of_loops)
endif()

# Libraries that are built as in a release where SPLATCUT_SANITIZE_LOOPS is OFF: those whose own tests check their loops,
# so that under tsan the tests of the window, which call them again and again, end in an hour.
function(splatcut_loops)
  if(NOT SPLATCUT_SANITIZE_LOOPS)
    set_target_properties(${ARGV} PROPERTIES SPLATCUT_NOT_SANITIZED ON)
    foreach(library IN LISTS ARGV)
      target_compile_options(${library} PRIVATE -O3)
    endforeach()
  endif()
endfunction()
