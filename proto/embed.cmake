# cmake -DIN=file -DOUT=file.cpp -DNAME=function -P embed.cmake: one text file as one function.
file(READ ${IN} text)
if(text MATCHES "\\)chorus\"")
  message(FATAL_ERROR "${IN} contains the closing mark of the raw string")
endif()
file(WRITE ${OUT} "// Generated from ${NAME}.
#include \"proto/embedded.h\"

namespace chorus::proto {

std::string_view ${NAME}() { return R\"chorus(${text})chorus\"; }

}  // namespace chorus::proto
")
