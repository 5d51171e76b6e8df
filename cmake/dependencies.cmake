# Libraries that burin is built on. Debian packages: cmake/packages.txt.
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)

# CGAL says more than a reader of the log needs.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
set(CMAKE_MESSAGE_LOG_LEVEL_BEFORE ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(CGAL REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL ${CMAKE_MESSAGE_LOG_LEVEL_BEFORE})

find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB REQUIRED)
# By pkg-config: its CMake package asks for the headers of Cairo and GLib, which the parser of path data does not need.
pkg_check_modules(2geom REQUIRED IMPORTED_TARGET 2geom)
pkg_check_modules(pugixml REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(polyclipping REQUIRED IMPORTED_TARGET polyclipping)
# By pkg-config: Debian's CMake package of OpenImageIO asks for its tools, and those for Qt.
pkg_check_modules(openimageio REQUIRED IMPORTED_TARGET GLOBAL OpenImageIO)
add_library(OpenImageIO::OpenImageIO ALIAS PkgConfig::openimageio)
pkg_check_modules(glm REQUIRED IMPORTED_TARGET glm)
pkg_check_modules(osmesa REQUIRED IMPORTED_TARGET osmesa)
pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)
