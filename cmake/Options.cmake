# What every target is compiled with: mixloop_options is linked by all of ours.
add_library(mixloop_options INTERFACE)
target_include_directories(mixloop_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(
  mixloop_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
            # Designated initialisers leave the rest at its defaults, on purpose.
            -Wno-missing-field-initializers
            # The same bytes from every route and build type: no fused multiply-add that one
            # translation unit has and another has not.
            -ffp-contract=off
            # GCC 12 sees overlaps in std::string's operator+ (GCC bug 105651), and reads past the ends of small
            # Eigen vectors and of spans, where there are none.
            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-array-bounds -Wno-stringop-overread>)
if(MIXLOOP_WERROR)
  target_compile_options(mixloop_options INTERFACE -Werror)
endif()

set(MIXLOOP_SANITIZE "" CACHE STRING "sanitizers, as -fsanitize= takes them (address,undefined or thread)")
if(MIXLOOP_SANITIZE)
  add_compile_options(-fsanitize=${MIXLOOP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${MIXLOOP_SANITIZE})
endif()
