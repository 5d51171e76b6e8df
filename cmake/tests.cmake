# burin_add_test(<name> LABEL <unit|property|cli|shader|render|fuzz> SOURCES <files> [LIBS <libraries>] [TIMEOUT <s>])
#
# A GoogleTest program and one CTest entry for it. BURIN_SHARED_DATA, BURIN_SOURCE_DIR and BURIN_BINARY_DIR are
# compile definitions; a test that needs shared data calls GTEST_SKIP() with the reason where it is absent.
function(burin_add_test name)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LIBS" ${ARGN})
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE burin_flags ${ARG_LIBS} GTest::gtest GTest::gtest_main)
    target_compile_definitions(${name} PRIVATE
        BURIN_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data"
        BURIN_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
        BURIN_BINARY_DIR="${PROJECT_BINARY_DIR}")
    # Tests assert contracts too.
    target_compile_options(${name} PRIVATE -UNDEBUG)
    # Unit tests are built longer than they run.
    if(ARG_LABEL STREQUAL "unit")
        target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
