# Compile flags that every target of burin gets, as the interface target burin_flags.
add_library(burin_flags INTERFACE)
target_compile_options(burin_flags INTERFACE
    -Wall -Wextra -Wshadow
    # Designated initialisers leave defaults alone on purpose.
    -Wno-missing-field-initializers
    # gcc 12 warns of overlaps in joined strings where there are none (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # No fused multiply-add: equal bytes on every machine.
    -ffp-contract=off
    $<$<BOOL:${BURIN_WERROR}>:-Werror>)
# Libraries that a program does not call are not loaded with it: each brings dozens of others.
target_link_options(burin_flags INTERFACE -Wl,--as-needed)
