# Debian's per-module OpenCV packages ship headers and libraries but no CMake config (that is in the
# 640 MB libopencv-dev), so the three modules used are found by hand. Headers are SYSTEM: OpenCV 4.6
# warns under C++20.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
add_library(opencv INTERFACE)
target_include_directories(opencv SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
foreach(module core imgproc video)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  target_link_libraries(opencv INTERFACE ${OPENCV_${module}_LIBRARY})
endforeach()
