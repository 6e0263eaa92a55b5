# Proves that file_length_test.cmake can fail, on a tree without git: 500 lines pass, 501 do not, data may be
# longer. -DSCRIPT=file_length_test.cmake -DFOLDER=<scratch>
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
string(REPEAT "x; [\n" 500 limit)

file(REMOVE_RECURSE ${FOLDER})
file(WRITE ${FOLDER}/core/a.cpp "${limit}")
file(WRITE ${FOLDER}/models/m/data/table.csv "${limit}${limit}")
file(WRITE ${FOLDER}/build/release/generated.cpp "${limit}${limit}")
expect("a tree at the limit" pass "")
foreach(file core/b.hpp docs/theory.md scripts/run.sh .ci/run)
  file(WRITE ${FOLDER}/${file} "${limit}\n")
  expect("a longer ${file}" fail "${file}: 501 lines")
  file(REMOVE ${FOLDER}/${file})
endforeach()
expect_empty_tree_fails()
