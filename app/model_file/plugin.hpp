#pragma once
/// A plugin: a shared library whose elements `drev ... --plugin FILE` takes in. One of its sources says what
/// it registers; nothing of it is called before the stamp has shown that it fits.
///
///   #include <drev/app/model_file/plugin.hpp>
///   DREV_PLUGIN() { drev::app::register_element<MyCoupling>("my_coupling", list); }
///
/// It is compiled against drev's headers and linked to none of its libraries (CMake target drev::plugin):
/// what it calls is in the program that loads it, so that there is one table of elements.
#include <drev/app/model_file/element_table.hpp>
#include <drev/core/element.hpp>
#include <drev/core/version.hpp>
#include <drev/headers_stamp.hpp>

#define DREV_TEXT_OF(macro) DREV_TEXT_OF_EXPANDED(macro)
#define DREV_TEXT_OF_EXPANDED(text) #text

/// What a plugin and the program that loads it must have in common: classes are passed between them.
#define DREV_PLUGIN_STAMP \
  "drev " DREV_VERSION ", headers " DREV_HEADERS_STAMP ", with Eigen "                               \
  DREV_TEXT_OF(EIGEN_WORLD_VERSION) "." DREV_TEXT_OF(EIGEN_MAJOR_VERSION) " at multiples of "        \
  DREV_TEXT_OF(EIGEN_MAX_ALIGN_BYTES) " bytes, string ABI " DREV_TEXT_OF(_GLIBCXX_USE_CXX11_ABI)

extern "C" const char* drev_plugin_stamp();
extern "C" void drev_plugin_register();

#define DREV_PLUGIN()                                           \
  const char* drev_plugin_stamp() { return DREV_PLUGIN_STAMP; } \
  void drev_plugin_register()
