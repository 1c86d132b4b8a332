# Derivatives are carried four at a time (estimation/jet.hpp): with AVX2 a fit takes a third of the time. What is
# compiled where it is used, as the Python package is by pip, has it where the machine does; -DSMS_AVX2=OFF is for a
# package that goes to others. A wheel does both: BOTH compiles the module twice, and sms/_dispatch.py loads the copy that
# the machine runs. Alignment stays that of the system's libraries, which were compiled without.
set(SMS_AVX2 AUTO CACHE STRING "AVX2 on the desk, in double precision: ON, OFF, BOTH (a copy with and one without, in a \
Python package for others), or AUTO (in the Python package, where it runs)")
set_property(CACHE SMS_AVX2 PROPERTY STRINGS AUTO ON OFF BOTH)
if(SMS_AVX2 STREQUAL "AUTO" AND SKBUILD AND NOT CMAKE_CROSSCOMPILING)
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") ? 0 : 1; }" SMS_RUNS_AVX2)
endif()
add_library(sms_simd INTERFACE)
if(SMS_AVX2 STREQUAL "ON" OR (SMS_AVX2 STREQUAL "AUTO" AND SMS_RUNS_AVX2))
  target_compile_options(sms_simd INTERFACE -mavx2)
  target_compile_definitions(sms_simd INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
endif()
