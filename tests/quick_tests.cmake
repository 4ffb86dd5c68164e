# Read by ctest: labels a short list of cases `quick`, those that .ci/sanitize runs. In it: what reads files of
# others, what has threads of its own, and maximum flow. The other cases of `threads:` take 200 s each under tsan.
set(quick_scene_tests ": ?(ply:|spz:|compressed ply|COLMAP|transforms|Inria|bad (files|cameras)|saving:|round trip|Morton)")
set(quick_segment_tests
    "small ranges|restart forgets|undo: a snapshot|parts: clicks on four|indices that lead|a file cut short|prepare_scene fills")
set(quick_studio_tests "threads: (random|exports|trouble|the end)|settings:")
foreach(program scene_tests segment_tests studio_tests)
  foreach(test IN LISTS ${program}_TESTS)
    if(test MATCHES "${quick_${program}}")
      set_tests_properties("${test}" PROPERTIES LABELS quick)
    endif()
  endforeach()
endforeach()
