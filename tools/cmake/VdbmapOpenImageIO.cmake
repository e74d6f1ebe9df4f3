# What only the module that writes pictures links to.
# Debian's config of OpenImageIO lists a folder of OpenCV's headers, which need not be there.
find_package(OpenImageIO REQUIRED CONFIG)
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
  get_target_property(folders OpenImageIO::OpenImageIO ${property})
  list(FILTER folders EXCLUDE REGEX "opencv")
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${folders}")
endforeach()
