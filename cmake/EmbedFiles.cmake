# Writes a C++ source with the texts of files, and the SHA-256 of each, by which a page may say which scripts are its own.
# Run with cmake -P and -D for each of
#   OUTPUT  HEADER  FILES (a list of NAME=PATH)

file(WRITE "${OUTPUT}.new" "// Made from the files that are named in it.\n#include \"${HEADER}\"\n")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
  set(name "${CMAKE_MATCH_1}")
  set(path "${CMAKE_MATCH_2}")
  file(READ "${path}" text)
  if(text MATCHES "</[sS][cC][rR][iI][pP][tT]|</[sS][tT][yY][lL][eE]|<!--|\\)embedded\"")
    message(FATAL_ERROR "${path} cannot be embedded: it contains the end of a script or style")
  endif()
  string(SHA256 hash "${text}")
  file(APPEND "${OUTPUT}.new" "\n// ${path}\nconst EmbeddedFile ${name} = {R\"embedded(")
  file(APPEND "${OUTPUT}.new" "${text}")
  file(APPEND "${OUTPUT}.new" ")embedded\",\n  \"${hash}\"};\n")
endforeach()
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
