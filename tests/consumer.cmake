# What cmake --install lays down serves a project that knows nothing of this one.
set(consumer_prefix "${CMAKE_CURRENT_BINARY_DIR}/consumer/prefix")
set(consumer_options -DCMAKE_PREFIX_PATH=${consumer_prefix} -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
                     -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER})

add_test(NAME Consumer.Installs COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${consumer_prefix})
add_test(NAME Consumer.FindsBuildsAndRuns
  COMMAND ${CMAKE_CTEST_COMMAND}
          --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer ${CMAKE_CURRENT_BINARY_DIR}/consumer/build
          --build-generator ${CMAKE_GENERATOR} --build-makeprogram ${CMAKE_MAKE_PROGRAM}
          --build-options ${consumer_options}
          --test-command consumer)
add_test(NAME Consumer.InstalledCommandRuns COMMAND ${consumer_prefix}/bin/cairn info builtin:cornell)
set_tests_properties(Consumer.Installs PROPERTIES FIXTURES_SETUP installed)
set_tests_properties(Consumer.FindsBuildsAndRuns Consumer.InstalledCommandRuns
  PROPERTIES FIXTURES_REQUIRED installed)
