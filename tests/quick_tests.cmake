# The cases that run under the sanitizers, by the labels of QUICK_CASE in the sources: one target of the files that hold
# them, a test of ctest each label. Here is what must have a label; a label that is not here, and one without a case,
# stop the configuration.
set(quick_labels
  # readers of files of others: every scene format by its name (held by scene_formats_test.cpp), cameras, the rest
  "ply" "compressed.ply" "splat" "spz" "sog" "streamed sog" "lcc" "lcc2" "rad" "glb" "ksplat"
  "Inria cameras" "transforms" "COLMAP" "PNG" "JSON" "seeds" "suite" "work file" "prepared cache" "settings" "command line" "jobs" "requests"
  # threads of ours, and loops of TBB that write one array
  "task thread" "frame thread" "depth sorter" "mailbox" "loops"
  # index arithmetic
  "max flow")

set(quick_sources)
set(found_labels)
foreach(source IN LISTS scene_sources segment_sources render_sources studio_sources reader_sources)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  file(READ ${source} text)
  string(REGEX MATCHALL "QUICK_CASE\\([ \n]*\"[^\"]*\"" cases "${text}")
  foreach(case IN LISTS cases)
    string(REGEX REPLACE "[^\"]*\"([^\"]*)\"" "\\1" label "${case}")
    list(APPEND found_labels "${label}")
    list(APPEND quick_sources ${source})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES quick_sources)
list(REMOVE_DUPLICATES found_labels)
foreach(label IN LISTS quick_labels)
  if(NOT label IN_LIST found_labels)
    message(FATAL_ERROR "No test case has QUICK_CASE(\"${label}\", ...), which tests/quick_tests.cmake wants under the sanitizers.")
  endif()
endforeach()
foreach(label IN LISTS found_labels)
  if(NOT label IN_LIST quick_labels)
    message(FATAL_ERROR "QUICK_CASE(\"${label}\", ...) is none of the labels of tests/quick_tests.cmake.")
  endif()
endforeach()

if(SPLATCUT_SANITIZE)
  splatcut_test_program(quick_tests "window;cli;lab;still_life" ${quick_sources})
  target_compile_options(quick_tests PRIVATE -Wno-maybe-uninitialized)
  set_target_properties(quick_tests PROPERTIES UNITY_BUILD_BATCH_SIZE 10)  # one unit would keep one core waiting
  foreach(label IN LISTS quick_labels)
    add_test(NAME "quick: ${label}" COMMAND quick_tests "--test-suite=quick: ${label}")
    set_tests_properties("quick: ${label}" PROPERTIES LABELS quick FAIL_REGULAR_EXPRESSION "test cases: +0 ")
  endforeach()
endif()
