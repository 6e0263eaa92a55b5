# cmake -DFILE=.. -DSYMBOL=.. -DOUTPUT=.. -P embed.cmake: FILE as a C++ source (see DrevEmbed.cmake).
# Read as hexadecimal, since CMake's own text handling stumbles over ';' and '['.
file(READ ${FILE} hex HEX)
string(LENGTH "${hex}" digits)
math(EXPR bytes "${digits} / 2")
string(REGEX REPLACE "(..)" "\\\\x\\1" text "${hex}")
set(line "")
foreach(i RANGE 1 24)
  string(APPEND line "\\\\x..")
endforeach()
string(REGEX REPLACE "(${line})" "\\1\"\n    \"" text "${text}")
get_filename_component(name ${FILE} NAME)
file(WRITE ${OUTPUT} "// ${name}, embedded by cmake/embed.cmake.
#include <string_view>

namespace drev::data {
extern const std::string_view ${SYMBOL};
constinit const std::string_view ${SYMBOL}{
    \"${text}\",
    ${bytes}};
}  // namespace drev::data
")
