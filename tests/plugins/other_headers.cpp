// A plugin built with other headers of the same version: nothing of it may be called.
#include <drev/app/model_file/plugin.hpp>

#include <cstdlib>
#include <string>

extern "C" const char* drev_plugin_stamp() {
  static const std::string stamp = [] {
    std::string text = DREV_PLUGIN_STAMP;
    const std::string own = DREV_HEADERS_STAMP;
    return text.replace(text.find(own), own.size(), "0123456789ab");
  }();
  return stamp.c_str();
}
extern "C" void drev_plugin_register() { std::abort(); }
