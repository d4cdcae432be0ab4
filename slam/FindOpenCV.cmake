# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# Finds the four OpenCV modules Glint uses: core, imgproc, features2d, flann.
# Debian's own OpenCVConfig.cmake comes only with libopencv-dev, which pulls in some 170 packages.
# Defines the imported target OpenCV::glint.
find_path(OpenCV_INCLUDE_DIR opencv2/features2d.hpp PATH_SUFFIXES opencv4)
set(_opencv_libraries)
foreach(module core imgproc features2d flann)
  find_library(OpenCV_${module}_LIBRARY opencv_${module})
  list(APPEND _opencv_required OpenCV_${module}_LIBRARY)
  list(APPEND _opencv_libraries "${OpenCV_${module}_LIBRARY}")
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV REQUIRED_VARS OpenCV_INCLUDE_DIR ${_opencv_required})
if(OpenCV_FOUND AND NOT TARGET OpenCV::glint)
  add_library(OpenCV::glint INTERFACE IMPORTED)
  set_target_properties(OpenCV::glint PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIR}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${_opencv_libraries}")
endif()
mark_as_advanced(OpenCV_INCLUDE_DIR ${_opencv_required})
