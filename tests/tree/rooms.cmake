# The rooms of the source tree, lowest first, and which rooms each may include beside itself. A room includes only
# rooms that stand above it in this table, so that no two include each other. A file belongs to the deepest room
# that holds it: solvers/statics.hpp to solvers, solvers/run/peaks.hpp to solvers/run.
set(room_table
  "core:"
  "elements:core"
  "solvers/linear:core"
  "solvers/contact:core solvers/linear"
  "solvers/run:core solvers/linear"
  "solvers/fields:core solvers/linear"
  "solvers/modes:core solvers/linear"
  "solvers/periodic:core solvers/linear solvers/run solvers/modes"
  "solvers/stepping:core solvers/linear solvers/contact solvers/run"
  "solvers/series:core solvers/linear"
  "solvers/exact:core solvers/linear solvers/contact solvers/run solvers/series"
  "solvers/strength:core solvers/run solvers/periodic"
  "solvers:core solvers/linear solvers/contact solvers/run solvers/modes solvers/periodic solvers/stepping solvers/exact"
  "solvers/batch:core solvers/linear solvers/run solvers/stepping solvers/exact"
  "solvers/accuracy:core solvers/run solvers/periodic solvers/stepping solvers/exact solvers"
  "solvers/reduction:core solvers/linear solvers/run solvers/modes solvers/exact solvers solvers/accuracy"
  "models/gears:core elements solvers/linear solvers/fields"
  "models/shafts:core elements solvers/linear solvers/run solvers/modes solvers/fields"
  "models:core elements solvers/* models/*"
  "advice:core elements solvers/* models"
  "app/base:core models"
  "app/model_file:core elements solvers/strength models/*"
  "app/model_file/gears:core models models/gears app/model_file"
  "app/model_file/writing:core elements models app/model_file"
  "app/import:core models app/base app/model_file app/model_file/writing"
  "app/run:core solvers/* models advice app/base app/model_file"
  "app/results:core solvers/* models/* app/base app/run"
  "app/report:core elements solvers/* models app/base app/model_file app/run app/results"
  "app/chart:core solvers/* models app/base app/run"
  "app/study:core elements solvers/* models/* app/base app/run app/chart"
  "app/fmi/import:core app/base app/model_file"
  "app/fmi:core solvers/* models app/base app/model_file app/model_file/writing app/run app/fmi/import"
  "app/fmi/library:core app/fmi"
  "app/cli:core solvers/* models app/base app/model_file app/run"
  "app/mpi:"
  "app/variants:core solvers/* models app/base app/model_file app/run app/results app/cli app/mpi"
  "app/commands:core elements solvers/* models/* advice app/*"
  "app:app/*"
  "python/bindings:core elements solvers/* models advice app/*")

# rooms: their names, in order; <room>_may: what it may include, itself among it. "solvers/*": every room there
# that stands above in the table.
set(rooms "")
foreach(row IN LISTS room_table)
  string(REGEX MATCH "^[^:]+" room "${row}")
  string(REGEX REPLACE "^[^:]+:" "" may "${row}")
  string(REPLACE " " ";" may "${may}")
  set(${room}_may ${room})
  foreach(other IN LISTS may)
    if(other MATCHES "^(.*)/\\*$")
      set(group ${CMAKE_MATCH_1})
      foreach(above IN LISTS rooms)
        if(above STREQUAL group OR above MATCHES "^${group}/")
          list(APPEND ${room}_may ${above})
        endif()
      endforeach()
    elseif(NOT other IN_LIST rooms)
      message(FATAL_ERROR "rooms.cmake: ${room} may include ${other}, which does not stand above it")
    else()
      list(APPEND ${room}_may ${other})
    endif()
  endforeach()
  list(APPEND rooms ${room})
endforeach()

# room_of(<path> <result>): the deepest room that holds the file; empty: none.
function(room_of path result)
  set(${result} "" PARENT_SCOPE)
  get_filename_component(folder ${path} DIRECTORY)
  while(folder)
    if(folder IN_LIST rooms)
      set(${result} ${folder} PARENT_SCOPE)
      return()
    endif()
    get_filename_component(folder ${folder} DIRECTORY)
  endwhile()
endfunction()
