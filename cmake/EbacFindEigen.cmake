# Helps find_package(Eigen3) where only pip could install something. Used by our build and, installed beside
# ebacConfig.cmake, by whoever uses the library.
#
# A system Eigen goes first. Without one, every directory Python imports from may hold a `cmeel.prefix`, the
# install prefix of the PyPI package cmeel-eigen. The path of Python is asked at run time instead of guessed:
# in an isolated pip build it is a temporary directory.
find_package(Eigen3 3.4 QUIET NO_MODULE)
if(NOT Eigen3_FOUND)
  find_package(Python COMPONENTS Interpreter QUIET)
  if(Python_Interpreter_FOUND)
    execute_process(
      COMMAND "${Python_EXECUTABLE}" -c
              "import pathlib, sys; print(*(p for d in sys.path if (p := pathlib.Path(d, 'cmeel.prefix')).is_dir()), sep=';')"
      OUTPUT_VARIABLE ebac_cmeel_prefixes OUTPUT_STRIP_TRAILING_WHITESPACE)
    list(APPEND CMAKE_PREFIX_PATH ${ebac_cmeel_prefixes})
    unset(ebac_cmeel_prefixes)
  endif()
endif()
