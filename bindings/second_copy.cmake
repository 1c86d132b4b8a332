# The module a second time, compiled with AVX2 into a build of its own, and installed beside the first as _core_avx2;
# and _cpu, which says whether the machine runs it.
include(ExternalProject)
set(second "${CMAKE_BINARY_DIR}/avx2")
set(handed_on SMS_ESTIMATION Ceres_DIR Eigen3_DIR pybind11_DIR CMAKE_BUILD_TYPE CMAKE_CXX_FLAGS CMAKE_C_COMPILER
              CMAKE_CXX_COMPILER CMAKE_MAKE_PROGRAM CMAKE_OSX_ARCHITECTURES CMAKE_OSX_DEPLOYMENT_TARGET)
set(arguments -DSMS_AVX2=ON -DSMS_TESTS=OFF -DSMS_IK_TABLES=OFF -DSMS_FMU=OFF)
foreach(name IN LISTS handed_on)
  if(DEFINED ${name})
    list(APPEND arguments "-D${name}=${${name}}")
  endif()
endforeach()
ExternalProject_Add(core_avx2
  SOURCE_DIR "${PROJECT_SOURCE_DIR}"
  PREFIX "${second}"
  BINARY_DIR "${second}/build"
  # The Python that scikit-build-core found, then what differs from this build.
  CMAKE_ARGS -C "${CMAKE_BINARY_DIR}/CMakeInit.txt" ${arguments} "-DCMAKE_INSTALL_PREFIX=${second}/installed"
  BUILD_ALWAYS ON
  INSTALL_COMMAND "${CMAKE_COMMAND}" --install . --strip
  DEPENDS _core)  # one after the other: a compiler takes up to 1.6 GB
install(FILES "${second}/installed/sms/_core${PYTHON_MODULE_EXTENSION}" DESTINATION sms
        RENAME "_core_avx2${PYTHON_MODULE_EXTENSION}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
        GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

python_add_library(_cpu MODULE WITH_SOABI cpu.c)
install(TARGETS _cpu LIBRARY DESTINATION sms)
