# Eigen and Ceres of SMS_CARRIED in place of the system's. A relative folder is one of the source.
if(SMS_CARRIED)
  get_filename_component(carried "${SMS_CARRIED}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
  if(NOT EXISTS "${carried}/lib/cmake/Ceres/CeresConfig.cmake" OR NOT EXISTS "${carried}/licences/ceres-solver/LICENSE")
    message(FATAL_ERROR "SMS_CARRIED=${SMS_CARRIED} holds no Ceres with its licence: packaging/wheel/dependencies.sh makes it")
  endif()
  set(Eigen3_DIR "${carried}/share/eigen3/cmake")
  set(Ceres_DIR "${carried}/lib/cmake/Ceres")
endif()
