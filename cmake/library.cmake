# burin_add_library(<name> SOURCES <files> [PUBLIC <libraries>] [PRIVATE <libraries>] [INCLUDE <public folders>])
#
# A static library with burin's flags.
function(burin_add_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;INCLUDE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC ${ARG_INCLUDE})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE burin_flags ${ARG_PRIVATE})
endfunction()
