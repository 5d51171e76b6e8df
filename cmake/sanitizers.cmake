# Adds the sanitizers named by BURIN_SANITIZE to burin_flags, and keeps assertions on with them.
if(BURIN_SANITIZE)
    target_compile_options(burin_flags INTERFACE
        -fsanitize=${BURIN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -UNDEBUG -g)
    target_link_options(burin_flags INTERFACE -fsanitize=${BURIN_SANITIZE})
endif()
