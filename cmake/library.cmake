# burin_add_library(<name> SOURCES <files> [PUBLIC <libraries>] [PRIVATE <libraries>] [INCLUDE <public folders>])
#
# A static library with burin's flags. A source of the list that does not exist is reported and left out, so that
# stages can be built one by one.
function(burin_add_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;INCLUDE" ${ARGN})
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_anchor.cpp.in
        "namespace burin { extern const char k_${name}_anchor; const char k_${name}_anchor = 0; }\n")
    configure_file(${CMAKE_CURRENT_BINARY_DIR}/${name}_anchor.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${name}_anchor.cpp
        COPYONLY)
    set(present ${CMAKE_CURRENT_BINARY_DIR}/${name}_anchor.cpp)
    foreach(source IN LISTS ARG_SOURCES)
        if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${source} OR EXISTS ${source})
            list(APPEND present ${source})
        else()
            message(STATUS "burin: ${name} is built without ${source}, which does not exist yet")
        endif()
    endforeach()
    add_library(${name} STATIC ${present})
    target_include_directories(${name} PUBLIC ${ARG_INCLUDE})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE burin_flags ${ARG_PRIVATE})
endfunction()
