# The same bytes from every route and build type: no fused multiply-add that one translation unit has and another
# has not.
string(APPEND CMAKE_CXX_FLAGS " -ffp-contract=off")

# GCC collects garbage a sixth of its time unless it may have a gigabyte first.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options(--param=ggc-min-heapsize=1000000 --param=ggc-min-expand=100)
endif()

set(MIXLOOP_SANITIZE "" CACHE STRING "sanitizers, as -fsanitize= takes them (address,undefined or thread)")

# The warnings that all of ours is compiled with.
add_library(mixloop_options INTERFACE)
target_compile_options(
  mixloop_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
            # Designated initialisers leave the rest at its defaults, on purpose.
            -Wno-missing-field-initializers
            # GCC 12 sees overlaps in std::string's operator+ (GCC bug 105651), and reads and writes past the ends of
            # strings, small Eigen vectors and spans, where there are none.
            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-array-bounds -Wno-stringop-overread -Wno-stringop-overflow>)
if(MIXLOOP_SANITIZE)
  # GCC 12 with a sanitizer takes what <regex> moves for uninitialised (GCC bug 105562).
  target_compile_options(mixloop_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(MIXLOOP_WERROR)
  target_compile_options(mixloop_options INTERFACE -Werror)
endif()

if(MIXLOOP_SANITIZE)
  add_compile_options(-fsanitize=${MIXLOOP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${MIXLOOP_SANITIZE})
endif()
