// A plugin of another drev: its stamp is not this one's, and nothing of it may be called.
#include <cstdlib>

extern "C" const char* drev_plugin_stamp() { return "drev 0.0.9, of old"; }
extern "C" void drev_plugin_register() { std::abort(); }
