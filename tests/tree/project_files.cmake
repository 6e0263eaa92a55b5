# project_files(<root> <result>): the files of the project, as git knows them; where the tree is no repository, all
# but build/, results/ and hidden folders other than .ci.
function(project_files root result)
  file(REAL_PATH ${root} root)
  execute_process(COMMAND git -C ${root} rev-parse --show-toplevel OUTPUT_VARIABLE top RESULT_VARIABLE no_git
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(no_git EQUAL 0 AND top STREQUAL root)
    execute_process(COMMAND git -C ${root} -c core.quotePath=off ls-files OUTPUT_VARIABLE files
                    COMMAND_ERROR_IS_FATAL ANY)
    string(STRIP "${files}" files)
    string(REPLACE "\n" ";" files "${files}")
  else()
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/* ${root}/.ci/*)
    list(FILTER files EXCLUDE REGEX "^(build|results|\\.git|\\.cache)/")
  endif()
  set(present "")
  foreach(name IN LISTS files)
    if(EXISTS ${root}/${name})
      list(APPEND present ${name})
    endif()
  endforeach()
  set(${result} "${present}" PARENT_SCOPE)
endfunction()
