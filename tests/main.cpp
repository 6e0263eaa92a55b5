// Catch2 v2 brings its main() this way; v3 links Catch2WithMain instead of this file.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
