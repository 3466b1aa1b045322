# cmake -DPROGRAM=... -DSTAGE=... -DMOVED=... -DBINDIR=... -DFILE=... -P moved_prefix.cmake
# PROGRAM reads FILE where the installed tree STAGE has moved to MOVED: with its programs in PATH, and from among them.
file(REMOVE_RECURSE ${MOVED})
file(COPY ${STAGE}/ DESTINATION ${MOVED})
get_filename_component(name ${PROGRAM} NAME)
file(COPY ${PROGRAM} DESTINATION ${MOVED}/${BINDIR})

function(expect_reading path program)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env PATH=${path} ${program} ${FILE} RESULT_VARIABLE status OUTPUT_VARIABLE said)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${program} with PATH=${path} ended with ${status}: ${said}")
    endif()
endfunction()
expect_reading(${MOVED}/${BINDIR} ${PROGRAM})
expect_reading(/nowhere ${MOVED}/${BINDIR}/${name})
