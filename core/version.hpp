#pragma once
/// drev's version; CMakeLists.txt reads it here.
#define DREV_VERSION "0.1.0"
