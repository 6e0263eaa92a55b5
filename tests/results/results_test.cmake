# The scripts that docs/results.md quotes read what drev writes. -DDREV -DSCRIPT -DFOLDER -DPROGRAM (with its
# arguments, a list)
file(REMOVE_RECURSE ${FOLDER})
set(channel mass_1.position_m)
execute_process(COMMAND ${DREV} run two_mass_backlash --out ${FOLDER} --format hdf5 --every 0.003
                RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "drev failed:\n${text}")
endif()
execute_process(COMMAND ${PROGRAM} ${SCRIPT} ${FOLDER} ${channel}
                RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
if(NOT result EQUAL 0 OR NOT text MATCHES "success 0\\.1444")
  message(FATAL_ERROR "${SCRIPT} failed (${result}):\n${text}")
endif()
