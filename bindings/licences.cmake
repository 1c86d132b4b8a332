# What a wheel carries of others, each with its licence, in its .dist-info/licenses: the texts are those of the sources that
# were compiled, and of the Python package pybind11.
set(licences "${SKBUILD_METADATA_DIR}/licenses")
file(GLOB pybind11_licence "${pybind11_DIR}/../../../../pybind11-${pybind11_VERSION}.dist-info/licenses/LICENSE")
if(NOT pybind11_licence)
  message(FATAL_ERROR "a wheel needs the licence of pybind11, and there is none beside ${pybind11_DIR}: build it with the "
                      "Python package pybind11, as pip does by itself")
endif()
find_package(Eigen3 REQUIRED NO_MODULE)  # found already, in another folder's scope: for the version
find_package(Ceres REQUIRED)
configure_file(third_party.md.in third_party.md @ONLY)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/third_party.md" DESTINATION "${licences}")
install(FILES ${pybind11_licence} DESTINATION "${licences}/pybind11")
install(FILES "${PROJECT_SOURCE_DIR}/libsms/fmi/third_party/LICENSE" DESTINATION "${licences}/fmi")
install(DIRECTORY "${carried}/licences/" DESTINATION "${licences}")
